#pragma once

#include <deque>
#include <takt/axis/axis.hpp>
#include <takt/axis/group.hpp>

namespace takt::daemon {

/// The axes of a machine in the order of its file. A deque, since an axis never moves in memory.
using Axes = std::deque<axis::Axis>;
/// Its groups likewise.
using Groups = std::deque<axis::Group>;

/// What programs move.
struct Movers {
    Axes& axes;
    Groups& groups;
};

}  // namespace takt::daemon
