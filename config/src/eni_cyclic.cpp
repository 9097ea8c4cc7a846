#include "eni_cyclic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <takt/wire/frame.hpp>
#include <takt/wire/registers.hpp>

#include "eni_commands.hpp"

namespace takt::config {

namespace {

using fieldbus::CyclicCommand;
using Kind = CyclicCommand::Kind;
using wire::Command;

constexpr std::int64_t Most16 = 0xFFFF;
constexpr std::int64_t Most32 = 0xFFFFFFFF;
constexpr std::int64_t LargestImage = 1'000'000;
constexpr std::size_t FrameBytes = wire::MaxDatagramData + wire::DatagramOverhead;

void readStates(XmlElement element, CyclicCommand& command, const EsiValues& values) {
    const auto states = element.children("State");
    command.inPreOp = command.inSafeOp = command.inOp = states.empty();
    for (const XmlElement state : states) {
        const std::string text = state.text();
        command.inPreOp = command.inPreOp || text == "PREOP";
        command.inSafeOp = command.inSafeOp || text == "SAFEOP";
        command.inOp = command.inOp || text == "OP";
        if (text != "PREOP" && text != "SAFEOP" && text != "OP" && text != "INIT") {
            values.error(state.line(), fmt::format("'{}' is no state", text),
                         "INIT, PREOP, SAFEOP, OP");
        }
    }
}

bool isLogical(Command command) noexcept {
    return command == Command::Lrd || command == Command::Lwr || command == Command::Lrw;
}

Kind kindOf(const CyclicCommand& command, const MailboxStateArea& mailboxStates) noexcept {
    const auto number = static_cast<Command>(command.command);
    const std::uint32_t ado = command.address >> 16U;
    if (isLogical(number)) {
        const bool states = number == Command::Lrd && mailboxStates.bits != 0 &&
                            command.address >= mailboxStates.start &&
                            command.address < mailboxStates.start + (mailboxStates.bits + 7) / 8;
        return states ? Kind::MailboxStates : Kind::ProcessData;
    }
    if (number == Command::Armw || number == Command::Frmw) {
        const bool whole = command.length == 4 || command.length == 8;
        return ado == wire::reg::DcSystemTime && whole ? Kind::ReferenceTime : Kind::Other;
    }
    const bool status = number == Command::Brd && ado == wire::reg::AlStatus && command.length >= 2;
    return status ? Kind::AlStatus : Kind::Other;
}

bool isHarmless(Command command) noexcept {
    return command == Command::Nop || command == Command::Aprd || command == Command::Fprd ||
           command == Command::Brd;
}

void readOffsets(XmlElement element, CyclicCommand& command, const EniNetwork& network,
                 const EsiValues& values) {
    const auto number = static_cast<Command>(command.command);
    const auto offset = [&](std::string_view name, std::uint32_t size, std::string_view image) {
        const std::int64_t bytes = values.child(element, name, 0, LargestImage, 0);
        if (bytes + command.length > size) {
            values.error(element.line(),
                         fmt::format("<{}> {} and {} bytes are beyond the {} of the process image",
                                     name, bytes, command.length, image),
                         fmt::format("{} bytes", size));
            return std::uint32_t{0};
        }
        return static_cast<std::uint32_t>(bytes);
    };
    if (number != Command::Lwr) {
        command.inputOffset = offset("InputOffs", network.listed.inputBytes, "inputs");
    }
    if (number != Command::Lrd) {
        command.outputOffset = offset("OutputOffs", network.listed.outputBytes, "outputs");
    }
}

CyclicCommand readCommand(XmlElement element, const MailboxStateArea& mailboxStates,
                          const EniNetwork& network, const EsiValues& values) {
    CyclicCommand command;
    readStates(element, command, values);
    const auto number =
        readNumber(element, "Cmd", static_cast<std::int64_t>(Command::Frmw), values);
    if (!number) values.error(element.line(), "the cyclic command has no <Cmd>", "0 to 14");
    command.command = static_cast<std::uint8_t>(number.value_or(0));
    if (isLogical(static_cast<Command>(command.command))) {
        command.address =
            static_cast<std::uint32_t>(readNumber(element, "Addr", Most32, values).value_or(0));
    } else {
        const auto adp = readNumber(element, "Adp", Most16, values).value_or(0);
        const auto ado = readNumber(element, "Ado", Most16, values).value_or(0);
        command.address = static_cast<std::uint32_t>(adp) | static_cast<std::uint32_t>(ado) << 16U;
    }
    const std::size_t told =
        hexBytes(element.child("Data").text()).value_or(std::vector<std::uint8_t>{}).size();
    command.length = static_cast<std::uint16_t>(values.child(
        element, "DataLength", 1, wire::MaxDatagramData, static_cast<std::int64_t>(told)));
    command.kind = kindOf(command, mailboxStates);
    const auto counter = readNumber(element, "Cnt", Most16, values);
    command.workingCounter = static_cast<std::uint16_t>(counter.value_or(0));
    if (command.length == 0) {
        values.error(element.line(), "the cyclic command has no data", "<DataLength> from 1");
    }
    if (command.kind == Kind::ProcessData) {
        if (!counter) {
            values.error(element.line(), "process data without <Cnt>: wrong ones would be believed",
                         "the working counter that is expected");
        }
        readOffsets(element, command, network, values);
    } else if (command.kind == Kind::Other && !isHarmless(static_cast<Command>(command.command))) {
        values.error(element.line(),
                     fmt::format("the cyclic command {} writes registers, which is not supported",
                                 command.command),
                     "NOP, reads, process data, and ARMW or FRMW at 0x0910 with 4 or 8 bytes");
    }
    if (element.child("CopyInfos").present()) {
        values.error(element.child("CopyInfos").line(),
                     "copies from slave to slave are not supported", "no <CopyInfos>");
    }
    return command;
}

void readFrame(XmlElement element, const MailboxStateArea& mailboxStates, EniNetwork& network,
               const EsiValues& values) {
    std::vector<CyclicCommand> commands;
    std::size_t bytes = 0;
    for (const XmlElement command : element.children("Cmd")) {
        commands.push_back(readCommand(command, mailboxStates, network, values));
        bytes += wire::DatagramOverhead + commands.back().length;
    }
    if (bytes > FrameBytes) {
        values.error(element.line(), fmt::format("the frame has {} bytes of commands", bytes),
                     fmt::format("at most {}", FrameBytes));
    }
    network.listed.frames.push_back(std::move(commands));
}

std::vector<EniVariable> readVariables(XmlElement image, std::uint32_t& bytes,
                                       const EsiValues& values) {
    bytes = static_cast<std::uint32_t>(values.child(image, "ByteSize", 0, LargestImage, 0));
    std::vector<EniVariable> variables;
    for (const XmlElement element : image.children("Variable")) {
        EniVariable variable;
        variable.name = element.child("Name").text();
        variable.type = element.child("DataType").text();
        variable.line = element.line();
        variable.bits =
            static_cast<std::uint32_t>(values.child(element, "BitSize", 0, 8 * LargestImage, 0));
        variable.firstBit =
            static_cast<std::uint32_t>(values.child(element, "BitOffs", 0, 8 * LargestImage, 0));
        if (variable.firstBit + variable.bits > std::uint64_t{8} * bytes || variable.bits == 0) {
            values.error(
                element.line(),
                fmt::format("the variable '{}' is outside the process image", variable.name),
                fmt::format("bits 0 to {}", 8 * std::uint64_t{bytes}));
        }
        variables.push_back(std::move(variable));
    }
    return variables;
}

// --- checks
// ---------------------------------------------------------------------------------------

/// An FMMU of the init commands: which logical bits it serves.
struct Mapping {
    std::uint64_t firstBit{0};
    std::uint64_t bits{0};
    bool reads{false};
    bool writes{false};
    int line{0};
};

std::uint16_t word(const std::vector<std::uint8_t>& data, std::size_t at) noexcept {
    return static_cast<std::uint16_t>(data[at] | data[at + 1] << 8U);
}

std::vector<Mapping> mappingsOf(const EniSlave& slave) {
    constexpr std::size_t most = 16;
    std::vector<Mapping> mappings;
    for (const fieldbus::ListedCommand& command : slave.listed.commands) {
        const bool up = command.transitions.has(fieldbus::Transition::InitToPreOp) ||
                        command.transitions.has(fieldbus::Transition::PreOpToSafeOp);
        for (std::size_t n = 0; up && n < most; ++n) {
            const auto at = static_cast<std::uint16_t>(wire::reg::Fmmu + n * wire::reg::FmmuSize);
            const auto data = writtenAt(command, at, wire::reg::FmmuSize);
            // The state of a mailbox lies in the SyncManager registers and is no process data.
            if (!data || ((*data)[12] & 1U) == 0 || isSyncManagerStatus(word(*data, 8))) continue;
            const std::uint64_t start = word(*data, 0) | std::uint64_t{word(*data, 2)} << 16U;
            const std::uint64_t last = start + word(*data, 4) - 1;
            mappings.push_back(
                {8 * start + (*data)[6], 8 * (last - start) + (*data)[7] + 1U - (*data)[6],
                 ((*data)[11] & 1U) != 0, ((*data)[11] & 2U) != 0, lineOf(command.origin)});
        }
    }
    return mappings;
}

/// Where the bits of a mapping lie in the image, by the command that carries them; empty: nothing
/// carries them.
std::optional<std::uint64_t> imageBit(const EniNetwork& network, const Mapping& mapping,
                                      bool outputs) {
    for (const auto& frame : network.listed.frames) {
        for (const CyclicCommand& command : frame) {
            const auto number = static_cast<Command>(command.command);
            if (command.kind != Kind::ProcessData) continue;
            if (number == (outputs ? Command::Lrd : Command::Lwr)) continue;
            const std::uint64_t start = 8 * std::uint64_t{command.address};
            const std::uint64_t end = start + 8 * std::uint64_t{command.length};
            if (mapping.firstBit < start || mapping.firstBit + mapping.bits > end) continue;
            const std::uint32_t offset = outputs ? command.outputOffset : command.inputOffset;
            return 8 * std::uint64_t{offset} + mapping.firstBit - start;
        }
    }
    return std::nullopt;
}

void checkShare(const EniNetwork& network, const EniSlave& slave, bool outputs,
                const EsiValues& values) {
    const fieldbus::ListedRange& share = outputs ? slave.listed.outputs : slave.listed.inputs;
    const char* const word = outputs ? "Send" : "Recv";
    std::uint64_t mapped = 0;
    for (const Mapping& mapping : mappingsOf(slave)) {
        if (!(outputs ? mapping.writes : mapping.reads)) continue;
        const auto bit = imageBit(network, mapping, outputs);
        if (!bit) {
            values.error(mapping.line,
                         fmt::format("slave '{}': no cyclic command carries what this FMMU maps",
                                     slave.name),
                         "a logical address inside a cyclic command");
        } else if (*bit < share.firstBit ||
                   *bit + mapping.bits > std::uint64_t{share.firstBit} + share.bits) {
            values.error(mapping.line,
                         fmt::format("slave '{}': this FMMU maps bits {} to {} of the process "
                                     "image, <{}> says {} to {}",
                                     slave.name, *bit, *bit + mapping.bits, word, share.firstBit,
                                     share.firstBit + share.bits),
                         "the same bits in both");
        }
        mapped += mapping.bits;
    }
    if (mapped < share.bits) {
        values.error(slave.place.line,
                     fmt::format("slave '{}': <{}> has {} bits, the init commands map {}",
                                 slave.name, word, share.bits, mapped),
                     "an FMMU for all process data");
    }
}

void checkCounter(const EniNetwork& network, const CyclicCommand& command, int line,
                  const EsiValues& values) {
    const auto number = static_cast<Command>(command.command);
    const std::uint64_t start = 8 * std::uint64_t{command.address};
    const std::uint64_t end = start + 8 * std::uint64_t{command.length};
    unsigned right = 0;
    for (const EniSlave& slave : network.slaves) {
        bool reads = false;
        bool writes = false;
        for (const Mapping& mapping : mappingsOf(slave)) {
            if (mapping.firstBit >= end || mapping.firstBit + mapping.bits <= start) continue;
            reads = reads || (mapping.reads && number != Command::Lwr);
            writes = writes || (mapping.writes && number != Command::Lrd);
        }
        right += (reads ? 1U : 0U) + (writes ? (number == Command::Lrw ? 2U : 1U) : 0U);
    }
    if (right == command.workingCounter) return;
    values.error(line,
                 fmt::format("<Cnt> is {}, but the FMMUs of the init commands give {}",
                             command.workingCounter, right),
                 fmt::format("{}", right));
}

}  // namespace

void readEniImage(XmlElement config, EniNetwork& network, const EsiValues& values) {
    const XmlElement image = config.child("ProcessImage");
    network.outputs = readVariables(image.child("Outputs"), network.listed.outputBytes, values);
    network.inputs = readVariables(image.child("Inputs"), network.listed.inputBytes, values);
}

void readEniCyclic(XmlElement config, const MailboxStateArea& mailboxStates, EniNetwork& network,
                   const EsiValues& values) {
    const auto cyclics = config.children("Cyclic");
    if (cyclics.size() != 1) {
        values.error(cyclics.empty() ? config.line() : cyclics[1].line(),
                     fmt::format("there are {} <Cyclic>", cyclics.size()),
                     "one; all process data travel in one cycle");
        if (cyclics.empty()) return;
    }
    constexpr std::int64_t second = 1'000'000;  // us
    const std::int64_t cycle = values.child(cyclics[0], "CycleTime", 1, second, 0);
    network.cycle = std::chrono::microseconds{cycle};
    if (cycle == 0) values.error(cyclics[0].line(), "<Cyclic> has no <CycleTime>", "microseconds");
    for (const XmlElement frame : cyclics[0].children("Frame")) {
        readFrame(frame, mailboxStates, network, values);
    }
    // Lines of the commands are needed once more, when all FMMUs are known.
    std::size_t f = 0;
    for (const XmlElement frame : cyclics[0].children("Frame")) {
        std::size_t c = 0;
        for (const XmlElement element : frame.children("Cmd")) {
            const CyclicCommand& command = network.listed.frames[f][c++];
            if (command.kind == Kind::ProcessData) {
                checkCounter(network, command, element.line(), values);
            }
        }
        ++f;
    }
}

void checkEniMapping(const EniNetwork& network, const EsiValues& values) {
    for (const EniSlave& slave : network.slaves) {
        checkShare(network, slave, true, values);
        checkShare(network, slave, false, values);
    }
}

}  // namespace takt::config
