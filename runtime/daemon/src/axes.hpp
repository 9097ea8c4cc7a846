#pragma once

#include <deque>
#include <takt/axis/axis.hpp>

namespace takt::daemon {

/// The axes of a machine in the order of its file. A deque, since an axis never moves in memory.
using Axes = std::deque<axis::Axis>;

}  // namespace takt::daemon
