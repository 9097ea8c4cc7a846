#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <takt/core/object_access.hpp>
#include <takt/core/time.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <takt/wire/al_state.hpp>
#include <variant>
#include <vector>

#include "logical_layout.hpp"
#include "mailbox.hpp"

namespace takt::fieldbus::ethercat {

struct RegisterStep {
    std::uint16_t address{0};
    std::vector<std::uint8_t> data;
    bool required{true};  ///< a slave without this register (working counter 0) stops the script
};

struct ObjectStep {
    core::ObjectAddress address{};
    std::vector<std::uint8_t> data;
    bool required{true};
    std::string origin;  ///< who wants it, for messages
    bool completeAccess{false};
};

struct StateStep {
    wire::AlState target{wire::AlState::None};
    core::Duration timeout{0};
};

/// A command of a list, with its number there.
struct CommandStep {
    ListedCommand command;
    std::size_t number{0};
};

using Step = std::variant<RegisterStep, ObjectStep, StateStep, CommandStep>;
/// What has to be done with one slave to get it from one state to the next, in order.
using Script = std::vector<Step>;

struct SlaveScripts {
    Script toPreOp;  ///< from INIT: mailbox, PREOP, objects, PDOs, SyncManagers, FMMUs, watchdog
    Script inPreOp;  ///< objects that a list wants written on the way to SAFEOP, then the axes' own
    Script armSync;  ///< SYNC0; the start time is entered with setSyncStart
    Script toSafeOp;
    Script toOp;
    Script recover;  ///< to OP again, from SAFEOP with an error
    Script backToSafeOp;
    Script backToPreOp;  ///< ends with SYNC0 stopped and process data unmapped
    Script backToInit;
};

[[nodiscard]] SlaveScripts makeScripts(const NetworkParams& network, std::size_t slave,
                                       const LogicalLayout& layout);

/// Sets up the mailbox of a device in INIT. Empty when it has none.
[[nodiscard]] Script makeMailboxScript(const SlaveParams& slave);

/// Objects that make the device use the configured PDOs (ETG.1000.6 5.6.7.4): assignments emptied,
/// mappings emptied, entries, counts, assignments. Empty when the device's defaults are used.
[[nodiscard]] Script makePdoScript(const SlaveParams& slave);

/// The start-up objects of a slave.
[[nodiscard]] Script startupSteps(const SlaveParams& slave);

/// Enters the start of the SYNC0 grid; the slave's own shift is added.
void setSyncStart(Script& armSync, const SlaveParams& slave, core::DcTime start);

/// The mailbox as the device description has it.
[[nodiscard]] std::optional<MailboxPlace> mailboxPlace(const SlaveParams& slave);

/// SYNC0 cycle of a slave: its own or the network's.
[[nodiscard]] core::Duration sync0Cycle(const NetworkParams& network, const SlaveParams& slave);

}  // namespace takt::fieldbus::ethercat
