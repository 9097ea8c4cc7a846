#include "eni_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <takt/wire/frame.hpp>
#include <takt/wire/registers.hpp>

#include "numbers.hpp"

namespace takt::config {

namespace {

using fieldbus::ListedCommand;
using fieldbus::ListedObject;
using fieldbus::Transition;
using wire::Command;

constexpr std::int64_t Most16 = 0xFFFF;
constexpr std::int64_t Most32 = 0xFFFFFFFF;
constexpr std::int64_t Hour = 3'600'000;  // ms
constexpr std::size_t LongestData = wire::MaxDatagramData;

struct TransitionName {
    std::string_view name;
    std::optional<Transition> taken;  ///< empty: a way that the master does not go
};

constexpr std::array TransitionNames{
    TransitionName{"IP", Transition::InitToPreOp}, TransitionName{"PS", Transition::PreOpToSafeOp},
    TransitionName{"SO", Transition::SafeOpToOp}, TransitionName{"OS", Transition::OpToSafeOp},
    TransitionName{"SP", Transition::SafeOpToPreOp}, TransitionName{"PI", Transition::PreOpToInit},
    // It goes down step by step and never by way of BOOT, so these have nothing to add.
    TransitionName{"OP", {}}, TransitionName{"OI", {}}, TransitionName{"SI", {}},
    TransitionName{"II", {}}, TransitionName{"PP", {}}, TransitionName{"SS", {}},
    TransitionName{"OO", {}}, TransitionName{"IB", {}}, TransitionName{"BI", {}},
    TransitionName{"BB", {}}};

fieldbus::Transitions readTransitions(XmlElement element, const EsiValues& values) {
    fieldbus::Transitions transitions;
    const auto elements = element.children("Transition");
    if (elements.empty()) {
        values.error(element.line(), "the command has no <Transition>",
                     "IP, PS, SO, OS, SP, PI, …");
    }
    for (const XmlElement transition : elements) {
        const std::string text = transition.text();
        const auto* const found =
            std::find_if(TransitionNames.begin(), TransitionNames.end(),
                         [&text](const TransitionName& entry) { return entry.name == text; });
        if (found == TransitionNames.end()) {
            values.error(transition.line(), fmt::format("'{}' is no transition", text),
                         "IP, PS, SO, OS, SP, PI, SI, OI, OP, II, PP, SS, OO, IB, BI, BB");
        } else if (found->taken) {
            transitions.add(*found->taken);
        }
    }
    return transitions;
}

std::optional<std::vector<std::uint8_t>> readHex(XmlElement element, std::string_view name,
                                                 const EsiValues& values) {
    const XmlElement found = element.child(name);
    if (!found.present()) return std::nullopt;
    auto bytes = hexBytes(found.text());
    if (!bytes || bytes->size() > LongestData) {
        values.error(found.line(), fmt::format("<{}>: this is not hexBinary", name),
                     fmt::format("pairs of hexadecimal digits, at most {} bytes", LongestData));
        return std::nullopt;
    }
    return bytes;
}

void readValidation(XmlElement element, ListedCommand& command, const EsiValues& values) {
    const XmlElement validate = element.child("Validate");
    if (!validate.present()) return;
    const auto data = readHex(validate, "Data", values);
    if (!data || data->empty()) {
        values.error(validate.line(), "<Validate> does not say what is to be read",
                     "<Data> in hexBinary");
        return;
    }
    fieldbus::ListedValidation validation;
    validation.data = *data;
    validation.mask = readHex(validate, "DataMask", values)
                          .value_or(std::vector<std::uint8_t>(data->size(), 0xFF));
    validation.timeout = values.milliseconds(validate, "Timeout", core::Duration{0});
    if (validation.mask.size() != data->size() || data->size() > command.data.size()) {
        values.error(
            validate.line(),
            fmt::format("<Validate>: {} bytes of data, {} of mask and {} of the command do "
                        "not fit together",
                        data->size(), validation.mask.size(), command.data.size()),
            "data and mask of one length, not longer than the command's data");
        return;
    }
    for (std::size_t i = 0; i < data->size(); ++i) {
        if (((*data)[i] & ~validation.mask[i]) == 0) continue;
        values.error(validate.line(), "<Validate> can never come true: data outside the mask",
                     "1 bits of <Data> only where <DataMask> has one");
        return;
    }
    command.validation = std::move(validation);
}

bool isLogical(std::int64_t command) noexcept {
    return command >= static_cast<std::int64_t>(Command::Lrd) &&
           command <= static_cast<std::int64_t>(Command::Lrw);
}

void readAddress(XmlElement element, ListedCommand& command, const EsiValues& values) {
    if (isLogical(command.command)) {
        const auto address = readNumber(element, "Addr", Most32, values);
        if (!address) values.error(element.line(), "the logical command has no <Addr>", "<Addr>");
        const auto number = static_cast<std::uint32_t>(address.value_or(0));
        command.adp = static_cast<std::uint16_t>(number);
        command.ado = static_cast<std::uint16_t>(number >> 16U);
        return;
    }
    const auto adp = readNumber(element, "Adp", Most16, values);
    const auto ado = readNumber(element, "Ado", Most16, values);
    if (!ado) values.error(element.line(), "the command has no <Ado>", "<Ado>, the register");
    command.adp = static_cast<std::uint16_t>(adp.value_or(0));
    command.ado = static_cast<std::uint16_t>(ado.value_or(0));
}

ListedCommand readInitCommand(XmlElement element, const EsiValues& values) {
    ListedCommand command;
    command.origin = format(Place{values.file(), element.line()});
    command.comment = element.child("Comment").text();
    command.transitions = readTransitions(element, values);
    command.beforeSlaves = readFlag(element, "BeforeSlave", values);
    const auto number = readNumber(element, "Cmd", Most16, values);
    constexpr auto last = static_cast<std::int64_t>(Command::Frmw);
    if (!number || *number < 1 || *number > last) {
        values.error(element.line(), "the command has no <Cmd> that there is", "1 to 14");
        return command;
    }
    command.command = static_cast<std::uint8_t>(*number);
    readAddress(element, command, values);
    const auto length =
        readNumber(element, "DataLength", static_cast<std::int64_t>(LongestData), values);
    if (auto data = readHex(element, "Data", values)) {
        command.data = std::move(*data);
    } else if (length) {
        command.data.resize(static_cast<std::size_t>(*length));
    }
    if (command.data.empty()) {
        values.error(element.line(), "the command carries no data", "<Data> or <DataLength>");
    }
    const auto counter = readNumber(element, "Cnt", Most16, values);
    if (counter) command.workingCounter = static_cast<std::uint16_t>(*counter);
    command.retries = static_cast<std::uint32_t>(values.child(element, "Retries", 0, Most16, 0));
    readValidation(element, command, values);
    return command;
}

/// Commands for CoE that upload only look at a value that nobody compares.
bool isDownload(XmlElement element, const EsiValues& values) {
    constexpr std::int64_t download = 1;
    constexpr std::int64_t upload = 2;
    const std::int64_t ccs = values.child(element, "Ccs", 0, 255, download);
    if (ccs == download) return true;
    const bool withData = !element.child("Data").text().empty();
    if (ccs == upload && !withData) {
        values.note(element.line(), "the CoE command only reads and is left out");
    } else {
        values.error(element.line(),
                     fmt::format("the CoE command has <Ccs> {}{}", ccs,
                                 withData ? " and data: it is not clear whether it writes" : ""),
                     "1: download");
    }
    return false;
}

}  // namespace

std::optional<std::int64_t> readNumber(XmlElement element, std::string_view name, std::int64_t most,
                                       const EsiValues& values) {
    const XmlElement found = element.child(name);
    if (!found.present()) return std::nullopt;
    return values.number(found.text(), found.line(), fmt::format("<{}>", name), 0, most);
}

bool readFlag(XmlElement element, std::string_view name, const EsiValues& values) {
    const XmlElement found = element.child(name);
    if (!found.present()) return false;
    const auto value = parseBool(found.text());
    if (!value) {
        values.error(found.line(), fmt::format("<{}> is neither true nor false", name),
                     "1, 0, true, false");
    }
    return value.value_or(false);
}

int lineOf(const std::string& origin) {
    int line = 0;
    const std::size_t colon = origin.rfind(':');
    if (colon != std::string::npos) {
        std::from_chars(origin.data() + colon + 1, origin.data() + origin.size(), line);
    }
    return line;
}

std::optional<std::vector<std::uint8_t>> writtenAt(const ListedCommand& command,
                                                   std::uint16_t address, std::size_t size) {
    const auto number = static_cast<Command>(command.command);
    const bool writes =
        number == Command::Apwr || number == Command::Fpwr || number == Command::Bwr;
    const std::size_t at = std::size_t{address} - command.ado;
    if (!writes || address < command.ado || at + size > command.data.size()) return std::nullopt;
    const auto first = command.data.begin() + static_cast<std::ptrdiff_t>(at);
    return std::vector<std::uint8_t>{first, first + static_cast<std::ptrdiff_t>(size)};
}

bool isSyncManagerStatus(std::uint16_t address) noexcept {
    constexpr std::uint16_t managers = 16;
    return address >= wire::reg::SyncManager &&
           address < wire::reg::SyncManager + managers * wire::reg::SyncManagerSize;
}

std::vector<ListedCommand> readInitCommands(XmlElement initCommands, const EsiValues& values) {
    std::vector<ListedCommand> commands;
    for (const XmlElement element : initCommands.children("InitCmd")) {
        commands.push_back(readInitCommand(element, values));
    }
    return commands;
}

std::vector<ListedObject> readCoeCommands(XmlElement initCommands, const EsiValues& values) {
    std::vector<ListedObject> objects;
    for (const XmlElement element : initCommands.children("InitCmd")) {
        if (readFlag(element, "Disabled", values) || !isDownload(element, values)) continue;
        ListedObject object;
        object.origin = format(Place{values.file(), element.line()});
        object.transitions = readTransitions(element, values);
        object.completeAccess = values.flag(element, "CompleteAccess", false);
        const auto index = readNumber(element, "Index", Most16, values);
        object.index = static_cast<std::uint16_t>(index.value_or(0));
        object.subindex = static_cast<std::uint8_t>(values.child(element, "SubIndex", 0, 255, 0));
        object.data = readHex(element, "Data", values).value_or(std::vector<std::uint8_t>{});
        if (object.index == 0 || object.data.empty()) {
            values.error(element.line(), "the CoE command does not say what to write where",
                         "<Index>, <SubIndex> and <Data>");
        }
        objects.push_back(std::move(object));
    }
    return objects;
}

core::Duration longestCoeTimeout(XmlElement initCommands, const EsiValues& values) {
    std::int64_t longest = 0;
    for (const XmlElement element : initCommands.children("InitCmd")) {
        longest = std::max(longest, values.child(element, "Timeout", 0, Hour, 0));
    }
    return std::chrono::milliseconds{longest};
}

}  // namespace takt::config
