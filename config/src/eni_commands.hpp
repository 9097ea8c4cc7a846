#pragma once

#include <takt/fieldbus/listed_params.hpp>
#include <vector>

#include "esi_values.hpp"

namespace takt::config {

/// The <InitCmd> children of <InitCmds>: datagrams of transitions, in file order.
[[nodiscard]] std::vector<fieldbus::ListedCommand> readInitCommands(XmlElement initCommands,
                                                                    const EsiValues& values);

/// The <InitCmd> children of <Mailbox>/<CoE>/<InitCmds>.
[[nodiscard]] std::vector<fieldbus::ListedObject> readCoeCommands(XmlElement initCommands,
                                                                  const EsiValues& values);

/// The largest <Timeout> of CoE commands; 0 where none is told.
[[nodiscard]] core::Duration longestCoeTimeout(XmlElement initCommands, const EsiValues& values);

/// The text of a child as "1", "true", "0" or "false".
[[nodiscard]] bool readFlag(XmlElement element, std::string_view name, const EsiValues& values);

/// Line of a command, out of "file:line".
[[nodiscard]] int lineOf(const std::string& origin);

/// A position, station or logical number of an element, decimal or hexadecimal.
[[nodiscard]] std::optional<std::int64_t> readNumber(XmlElement element, std::string_view name,
                                                     std::int64_t most, const EsiValues& values);

/// What a command sends into one register range, where it is a write that covers it.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> writtenAt(
    const fieldbus::ListedCommand& command, std::uint16_t address, std::size_t size);

/// An address in the registers of the SyncManagers, where FMMUs find the state of mailboxes.
[[nodiscard]] bool isSyncManagerStatus(std::uint16_t address) noexcept;

}  // namespace takt::config
