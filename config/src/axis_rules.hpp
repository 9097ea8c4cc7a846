#pragma once

#include "machine_parts.hpp"

/// What no schema can say about an axis: its numbers against each other and against its drive.
namespace takt::config {

/// Finds the slave that the axis names and marks it as taken. \return nullptr, after a message, if
/// it cannot
[[nodiscard]] SlavePart* tieToSlave(const AxisPart& axis, const ElementReader& drive,
                                    NetworkPart& network);

/// A drive that coasts, or whose reaction is not known, when the bus falls silent: a vertical axis
/// must confirm that its load is held.
void checkLostCommunication(const AxisPart& axis, const SlavePart& slave,
                            const ElementReader& drive, bool confirmed);

/// All rules that need the scaling and the limits.
void checkAxis(const AxisPart& axis, const NetworkPart& network);

}  // namespace takt::config
