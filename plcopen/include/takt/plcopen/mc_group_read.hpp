#pragma once

#include <array>
#include <takt/axis/group_port.hpp>
#include <takt/plcopen/enums.hpp>
#include <takt/plcopen/mc_read.hpp>

namespace takt::plcopen {

/// Exactly one state output is TRUE while Valid.
class MC_GroupReadStatus : public ReadBlock {
public:
    bool GroupMoving{false};
    bool GroupHoming{false};
    bool GroupErrorStop{false};
    bool GroupStandby{false};
    bool GroupStopping{false};
    bool GroupDisabled{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// Actual positions of this cycle by place.
class MC_GroupReadActualPosition : public ReadBlock {
public:
    MC_COORD_SYSTEM CoordSystem{MC_COORD_SYSTEM::mcACS};  ///< mcACS or mcMCS, which are the same

    std::array<double, axis::MaxGroupAxes> Position{};  ///< u

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// Why the group is in GroupErrorStop. The common output ErrorID is this error; `Error` speaks of
/// the block alone.
class MC_GroupReadError : public ReadBlock {
public:
    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

}  // namespace takt::plcopen
