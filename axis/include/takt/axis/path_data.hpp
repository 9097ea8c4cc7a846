#pragma once

#include <cstddef>
#include <takt/axis/group_command.hpp>
#include <takt/core/fixed_vector.hpp>

namespace takt::axis {

/// A path of a group that is kept and run as a whole: lines and arcs, one after the other.
struct PathData {
    static constexpr std::size_t MaxSegments = 32;

    struct Segment {
        GroupCommandKind kind{GroupCommandKind::MoveLinear};  ///< or MoveCircular
        GroupPoint point{};                                   ///< its end
        Arc arc{};                                            ///< of a MoveCircular
        /// The joint to the next segment is rounded from so far before it to so far after it, in
        /// path length; 0 = a stop there.
        double corner{0.0};
    };

    GroupPoint start{};
    core::FixedVector<Segment, MaxSegments> segments{};

    /// rt. Adds a straight line. \return false, and nothing changes, when full
    bool lineTo(const GroupPoint& point, double corner = 0.0) noexcept {
        return segments.push({GroupCommandKind::MoveLinear, point, {}, corner});
    }
    /// rt. Adds an arc. \return false, and nothing changes, when full
    bool arcTo(const GroupPoint& point, const Arc& arc, double corner = 0.0) noexcept {
        return segments.push({GroupCommandKind::MoveCircular, point, arc, corner});
    }
};

}  // namespace takt::axis
