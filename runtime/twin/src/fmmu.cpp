#include "fmmu.hpp"

#include <algorithm>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

namespace takt::twin {

FmmuList decodeFmmus(std::span<const std::uint8_t> registers, std::size_t count) noexcept {
    FmmuList list;
    for (std::size_t i = 0; i < count; ++i) {
        const auto b =
            registers.subspan(wire::reg::Fmmu + i * wire::reg::FmmuSize, wire::reg::FmmuSize);
        Fmmu fmmu;
        fmmu.logical = wire::load32(b, 0);
        fmmu.length = wire::load16(b, 4);
        fmmu.startBit = b[6] & 0x07;
        fmmu.stopBit = b[7] & 0x07;
        fmmu.physical = wire::load16(b, 8);
        fmmu.physicalBit = b[10] & 0x07;
        fmmu.read = (b[11] & 0x01) != 0;
        fmmu.write = (b[11] & 0x02) != 0;
        const bool active = (b[12] & 0x01) != 0 && fmmu.length > 0;
        if (active && (fmmu.read || fmmu.write)) list.push(fmmu);
    }
    return list;
}

}  // namespace takt::twin
