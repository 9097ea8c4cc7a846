#include <fmt/format.h>

#include <algorithm>
#include <takt/core/cia402.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>

#include "machine_parts.hpp"

namespace takt::config {

namespace {

/// The slave an input lies on, and what messages call it.
void readPlace(ElementReader& reader, const std::vector<AxisPart>& axes,
               axis::MachineStopInput& input) {
    const auto axis = reader.text("axis");
    const auto slave = reader.text("slave");
    const auto index = reader.integer("index", {1, 0xFFFF});
    const auto subindex = reader.integer("subindex", {0, 0xFF});
    if (axis.has_value() == slave.has_value()) {
        reader.error(axis ? "slave" : "", "the input lies neither on one axis nor on one slave",
                     "either axis=\"…\" or slave=\"…\" index=\"…\"");
        return;
    }
    if (slave) {
        input.slave = *slave;
        if (!index) reader.error("", "the object of the input is missing", "index=\"0x…\"");
        input.index = static_cast<std::uint16_t>(index.value_or(0));
        input.subindex = static_cast<std::uint8_t>(subindex.value_or(0));
        return;
    }
    if (index || subindex) {
        reader.error(index ? "index" : "subindex", "the input of an axis is always 60FDh",
                     "slave=\"…\" in the place of axis");
    }
    const auto found = std::find_if(axes.begin(), axes.end(), [&axis](const AxisPart& part) {
        return part.params.name == *axis;
    });
    if (found == axes.end()) {
        reader.error("axis", fmt::format("there is no axis '{}'", *axis));
        return;
    }
    input.slave = found->params.drive.slave;
    input.index = core::cia402::DigitalInputs;
}

/// Bits of an object among a slave's inputs, 0 when it is not mapped.
unsigned mappedBits(const fieldbus::SlaveParams& slave, std::uint16_t index,
                    std::uint8_t subindex) {
    for (const fieldbus::PdoParams& pdo : slave.inputs) {
        for (const fieldbus::PdoEntryParams& entry : pdo.entries) {
            if (entry.index == index && entry.subindex == subindex) return entry.bits;
        }
    }
    return 0;
}

void checkMapped(const ElementReader& reader, NetworkPart& network,
                 const axis::MachineStopInput& input) {
    if (input.slave.empty() || input.index == 0) return;  // reported already
    const SlavePart* const slave = network.find(input.slave);
    if (slave == nullptr) {
        reader.error("slave", fmt::format("there is no slave '{}'", input.slave));
        return;
    }
    if (!slave->params.device) return;
    const unsigned bits = mappedBits(slave->params, input.index, input.subindex);
    if (bits == 0) {
        reader.error("",
                     fmt::format("{:04X}h:{:02X} is not among the inputs of slave '{}'",
                                 input.index, input.subindex, input.slave),
                     "a mapped entry", "add it to an input PDO of the slave with <Pdo>");
    } else if (bits > 32) {
        reader.error("index", fmt::format("the entry has {} bits", bits), "at most 32 bits");
    } else if (input.bit >= bits) {
        reader.error("bit", fmt::format("the entry has {} bits", bits),
                     fmt::format("0 to {}", bits - 1));
    }
}

}  // namespace

axis::MachineStopParams readMachineStop(ElementReader reader, NetworkPart& network,
                                        const std::vector<AxisPart>& axes) {
    axis::MachineStopParams stop;
    if (!reader.present()) return stop;
    stop.time = reader.time("time", Sign::Positive).value_or(stop.time);
    stop.onFault = reader.flag("onFault").value_or(true);
    for (const XmlElement element : reader.children("Input")) {
        ElementReader item{element, "machine stop input", reader.place().file,
                           reader.diagnostics()};
        axis::MachineStopInput input;
        input.origin = format(item.place());
        readPlace(item, axes, input);
        input.bit =
            static_cast<std::uint8_t>(item.integer("bit", {0, 31}, Presence::Required).value_or(0));
        input.activeHigh =
            item.choice<bool>("active", {{"low", false}, {"high", true}}).value_or(false);
        item.finish();
        checkMapped(item, network, input);
        input.name = fmt::format("{} {:04X}h bit {}", input.slave, input.index, input.bit);
        stop.inputs.push_back(std::move(input));
    }
    reader.finish();
    return stop;
}

}  // namespace takt::config
