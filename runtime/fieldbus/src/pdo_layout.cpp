#include <takt/fieldbus/pdo_layout.hpp>

namespace takt::fieldbus {

namespace {

const std::vector<PdoParams>& pdosOf(const SlaveParams& slave, Direction direction) noexcept {
    return direction == Direction::Outputs ? slave.outputs : slave.inputs;
}

}  // namespace

core::PdoSlot findEntry(const SlaveParams& slave, Direction direction, std::uint16_t index,
                        std::uint8_t subindex) noexcept {
    constexpr std::uint8_t widest = 32;
    std::uint32_t offset = direction == Direction::Outputs ? slave.outputShift : slave.inputShift;
    for (const PdoParams& pdo : pdosOf(slave, direction)) {
        for (const PdoEntryParams& entry : pdo.entries) {
            const bool wanted = index != 0 && entry.index == index && entry.subindex == subindex;
            if (wanted && entry.bits <= widest) return {offset, entry.bits};
            offset += entry.bits;
        }
    }
    return {};
}

std::uint32_t processDataBytes(const SlaveParams& slave, Direction direction) noexcept {
    std::uint32_t bits = 0;
    for (const PdoParams& pdo : pdosOf(slave, direction)) {
        for (const PdoEntryParams& entry : pdo.entries) bits += entry.bits;
    }
    return (bits + 7) / 8;
}

}  // namespace takt::fieldbus
