#pragma once

#include <array>
#include <takt/fieldbus/fieldbus_params.hpp>

#include "slave_script.hpp"

namespace takt::fieldbus::ethercat {

/// The scripts of a slave whose commands are listed. On the way to SAFEOP the commands before the
/// first write to AL control are run in bring-up, for they arm SYNC0 and set up process data; the
/// rest in the cycle. Where the list has no way down, the master's own is taken.
[[nodiscard]] SlaveScripts makeListedScripts(const SlaveParams& slave);

/// Listed commands to all devices, before and after the devices' own, by Transition.
struct CommonScripts {
    std::array<Script, TransitionCount> before;
    std::array<Script, TransitionCount> after;
};

[[nodiscard]] CommonScripts makeCommonScripts(const NetworkParams& network);

}  // namespace takt::fieldbus::ethercat
