#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <takt/config/eni_reader.hpp>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/frame.hpp>
#include <takt/wire/registers.hpp>

#include "eni_commands.hpp"
#include "eni_cyclic.hpp"
#include "eni_device.hpp"
#include "xml_document.hpp"

namespace takt::config {

namespace {

namespace reg = wire::reg;
using fieldbus::ListedCommand;
using fieldbus::Transition;
using wire::Command;

fieldbus::ListedRange readRange(XmlElement processData, std::string_view name,
                                std::uint32_t imageBytes, const EsiValues& values) {
    const auto elements = processData.children(name);
    if (elements.empty()) return {};
    if (elements.size() > 1) {
        values.error(elements[1].line(), fmt::format("there is more than one <{}>", name),
                     "process data of a slave in one piece");
    }
    constexpr std::int64_t most = 8'000'000;
    fieldbus::ListedRange range;
    range.firstBit = static_cast<std::uint32_t>(values.child(elements[0], "BitStart", 0, most, 0));
    range.bits = static_cast<std::uint32_t>(values.child(elements[0], "BitLength", 0, most, 0));
    if (range.firstBit + std::uint64_t{range.bits} > 8 * std::uint64_t{imageBytes}) {
        values.error(elements[0].line(),
                     fmt::format("<{}> reaches to bit {} of the process image", name,
                                 range.firstBit + std::uint64_t{range.bits}),
                     fmt::format("at most {} bits", 8 * std::uint64_t{imageBytes}));
        return {};
    }
    return range;
}

/// A command in a slave's list that reaches another slave would be a fault that nobody sees.
void checkAddressee(const ListedCommand& command, const EniSlave& slave, std::size_t position,
                    const EsiValues& values) {
    const auto ownPosition = static_cast<std::uint16_t>(0U - position);
    const auto wrong = [&](std::uint16_t right) {
        values.error(
            lineOf(command.origin),
            fmt::format("slave '{}': the command goes to <Adp> {}", slave.name, command.adp),
            fmt::format("{}", right));
    };
    switch (static_cast<Command>(command.command)) {
        case Command::Aprd:
        case Command::Apwr:
        case Command::Aprw:
            if (command.adp != ownPosition) wrong(ownPosition);
            break;
        case Command::Fprd:
        case Command::Fpwr:
        case Command::Fprw:
            if (command.adp != slave.listed.station) wrong(slave.listed.station);
            break;
        case Command::Nop:
        case Command::Brd:
        case Command::Bwr:
        case Command::Brw:
        case Command::Lrd:
        case Command::Lwr:
        case Command::Lrw:
        case Command::Armw:
        case Command::Frmw:
            break;
    }
}

/// The words of the EEPROM that the commands read and validate must be those of <Info>.
void checkIdentity(const EniSlave& slave, const EsiValues& values) {
    const wire::Identity& identity = slave.device.identity;
    const std::map<std::uint32_t, std::pair<const char*, std::uint32_t>> words{
        {8, {"vendor", identity.vendor}},
        {10, {"product", identity.product}},
        {12, {"revision", identity.revision}},
        {14, {"serial number", identity.serial}}};
    std::uint32_t asked = 0;
    for (const ListedCommand& command : slave.listed.commands) {
        if (const auto address = writtenAt(command, reg::EepromAddress, 4)) {
            asked = wire::load32(*address, 0);
        }
        const bool reads = command.ado == reg::EepromData && command.validation &&
                           command.validation->data.size() >= 4;
        const auto word = words.find(asked);
        if (!reads || word == words.end()) continue;
        const std::uint32_t wanted = wire::load32(command.validation->data, 0);
        const std::uint32_t mask = wire::load32(command.validation->mask, 0);
        const auto& [name, told] = word->second;
        if ((told & mask) == wanted) continue;
        values.error(slave.place.line,
                     fmt::format("slave '{}' has {} {:#010x}, but the init command in line {} "
                                 "wants {:#010x}",
                                 slave.name, name, told, lineOf(command.origin), wanted),
                     "the same identity in both");
    }
}

void checkWayUp(const EniSlave& slave, const EsiValues& values) {
    struct Step {
        Transition transition;
        const char* name;
        std::uint8_t state;
    };
    for (const Step& step :
         {Step{Transition::InitToPreOp, "IP", 2}, Step{Transition::PreOpToSafeOp, "PS", 4},
          Step{Transition::SafeOpToOp, "SO", 8}}) {
        const bool asked = std::any_of(slave.listed.commands.begin(), slave.listed.commands.end(),
                                       [&](const auto& command) {
                                           const auto data = writtenAt(command, reg::AlControl, 1);
                                           return command.transitions.has(step.transition) &&
                                                  data && ((*data)[0] & 0x0FU) == step.state;
                                       });
        if (asked) continue;
        values.error(slave.place.line,
                     fmt::format("slave '{}': no init command of {} asks for its state", slave.name,
                                 step.name),
                     fmt::format("a write of {} to register 0x0120", step.state));
    }
}

EniSlave readSlave(XmlElement element, std::size_t position, const fieldbus::ListedNetwork& image,
                   const EsiValues& values) {
    EniSlave slave;
    const XmlElement info = element.child("Info");
    slave.place = {values.file(), info.present() ? info.line() : element.line()};
    slave.name = info.child("Name").text();
    if (slave.name.empty()) {
        values.error(slave.place.line, "the slave has no name", "<Info>/<Name>");
    }
    const auto station = readNumber(info, "PhysAddr", 0xFFFF, values);
    slave.listed.station = static_cast<std::uint16_t>(station.value_or(0));
    if (slave.listed.station == 0) {
        values.error(slave.place.line, fmt::format("slave '{}' has no station address", slave.name),
                     "<Info>/<PhysAddr> from 1 to 65535");
    }
    const auto own = static_cast<std::int64_t>(static_cast<std::uint16_t>(0U - position));
    const std::int64_t order = values.child(info, "AutoIncAddr", 0, 0xFFFF, own);
    if (order != own) {
        values.error(info.child("AutoIncAddr").line(),
                     fmt::format("slave '{}' is number {} of the file but has <AutoIncAddr> {}",
                                 slave.name, position + 1, order),
                     fmt::format("{}: slaves in frame order", own));
    }
    if (element.child("HotConnect").present()) {
        values.error(element.child("HotConnect").line(), "hot connect groups are not supported",
                     "slaves that are always there");
    }
    slave.listed.commands = readInitCommands(element.child("InitCmds"), values);
    slave.listed.objects =
        readCoeCommands(element.child("Mailbox").child("CoE").child("InitCmds"), values);
    const XmlElement processData = element.child("ProcessData");
    slave.listed.outputs = readRange(processData, "Send", image.outputBytes, values);
    slave.listed.inputs = readRange(processData, "Recv", image.inputBytes, values);
    readEniDevice(element, slave, values);
    for (const ListedCommand& command : slave.listed.commands) {
        checkAddressee(command, slave, position, values);
    }
    checkIdentity(slave, values);
    checkWayUp(slave, values);
    return slave;
}

/// What the PDOs hold must be what the image has room for; without PDOs the share is one gap.
void fitPdos(std::vector<fieldbus::PdoParams>& pdos, const fieldbus::ListedRange& share,
             const EniSlave& slave, const char* word, const EsiValues& values) {
    std::uint32_t bits = 0;
    for (const fieldbus::PdoParams& pdo : pdos) {
        for (const fieldbus::PdoEntryParams& entry : pdo.entries) bits += entry.bits;
    }
    constexpr std::uint32_t largestGap = 248;
    if (bits == 0 && share.bits != 0) {
        fieldbus::PdoParams gaps;
        for (std::uint32_t rest = share.bits; rest != 0; rest -= std::min(rest, largestGap)) {
            gaps.entries.push_back({0, 0, static_cast<std::uint8_t>(std::min(rest, largestGap))});
        }
        pdos = {gaps};
        return;
    }
    if (bits == share.bits || (bits + 7) / 8 * 8 == share.bits) return;
    values.error(slave.place.line,
                 fmt::format("slave '{}': the assigned PDOs have {} bits, <{}> has {}", slave.name,
                             bits, word, share.bits),
                 "the same number of bits");
}

void checkStations(const EniNetwork& network, const EsiValues& values) {
    std::map<std::uint16_t, std::string> stations;
    std::map<std::string, int> names;
    for (const EniSlave& slave : network.slaves) {
        const auto [first, fresh] = stations.emplace(slave.listed.station, slave.name);
        if (!fresh) {
            values.error(slave.place.line,
                         fmt::format("slave '{}' has the station address {} of '{}'", slave.name,
                                     slave.listed.station, first->second),
                         "each address once");
        }
        const auto [named, unique] = names.emplace(slave.name, slave.place.line);
        if (!unique) {
            values.error(slave.place.line,
                         fmt::format("there is a slave '{}' in line {}", slave.name, named->second),
                         "each name once");
        }
    }
}

void checkClock(const EniNetwork& network, int line, const EsiValues& values) {
    const bool wanted = std::any_of(network.slaves.begin(), network.slaves.end(),
                                    [](const EniSlave& slave) { return slave.dc.enabled; });
    std::size_t found = 0;
    for (const auto& frame : network.listed.frames) {
        found += static_cast<std::size_t>(
            std::count_if(frame.begin(), frame.end(), [](const fieldbus::CyclicCommand& command) {
                return command.kind == fieldbus::CyclicCommand::Kind::ReferenceTime;
            }));
    }
    if (found > 1 || (wanted && found == 0)) {
        values.error(
            line,
            fmt::format("{} cyclic commands hand the time of the reference clock round", found),
            "one ARMW or FRMW at register 0x0910");
    }
}

void readConfig(XmlElement config, EniNetwork& network, const EsiValues& values) {
    const XmlElement master = config.child("Master");
    network.listed.commands = readInitCommands(master.child("InitCmds"), values);
    const XmlElement states = master.child("MailboxStates");
    constexpr std::int64_t most32 = 0xFFFFFFFF;
    const MailboxStateArea area{
        static_cast<std::uint32_t>(values.child(states, "StartAddr", 0, most32, 0)),
        static_cast<std::uint32_t>(values.child(states, "Count", 0, 0xFFFF, 0))};
    readEniImage(config, network, values);
    const auto elements = config.children("Slave");
    constexpr std::size_t mostSlaves = 1000;
    if (elements.empty() || elements.size() > mostSlaves) {
        values.error(config.line(), fmt::format("the network has {} slaves", elements.size()),
                     "1 to 1000 <Slave>");
        return;
    }
    for (const XmlElement element : elements) {
        network.slaves.push_back(readSlave(element, network.slaves.size(), network.listed, values));
        EniSlave& slave = network.slaves.back();
        fitPdos(slave.outputs, slave.listed.outputs, slave, "Send", values);
        fitPdos(slave.inputs, slave.listed.inputs, slave, "Recv", values);
    }
    checkStations(network, values);
    readEniCyclic(config, area, network, values);
    checkEniMapping(network, values);
    checkClock(network, config.child("Cyclic").line(), values);
}

}  // namespace

std::optional<EniNetwork> readEni(const std::filesystem::path& file, Diagnostics& diagnostics) {
    const auto document = loadXml(file, MaxDeviceFile, diagnostics);
    if (!document) return std::nullopt;
    const std::size_t before = diagnostics.errorCount();
    const EsiValues values{document->file(), diagnostics};
    const XmlElement root = document->root();
    const XmlElement config = root.child("Config");
    EniNetwork network;
    network.file = document->file();
    if (root.name() != "EtherCATConfig" && root.name() != "EncryptedEtherCATConfig") {
        values.error(root.line(),
                     fmt::format("<{}> is not the root of a network file (ENI)", root.name()),
                     "<EtherCATConfig>");
    } else if (!config.present()) {
        values.error(root.line(), "there is no <Config>", "<Config> in plain text");
    } else {
        readConfig(config, network, values);
    }
    if (diagnostics.errorCount() != before) return std::nullopt;
    return network;
}

}  // namespace takt::config
