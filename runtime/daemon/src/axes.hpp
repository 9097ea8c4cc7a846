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

/// rt. Its set-point moves, or may do so at any moment. A stop that holds an axis at rest is none.
[[nodiscard]] inline bool isMoving(const axis::Axis& axis) noexcept {
    const axis::AxisView& view = axis.view();
    return view.inMotion() || !view.atRest;
}

}  // namespace takt::daemon
