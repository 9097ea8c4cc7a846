#pragma once

#include <takt/axis/group.hpp>

#include "axis_rig.hpp"

namespace takt::test {

using axis::GroupCommand;
using axis::GroupCommandKind;
using axis::GroupPoint;
using axis::GroupState;

inline axis::GroupParams testGroup() {
    axis::GroupParams p;
    p.name = "G";
    p.unit = "mm";
    p.axes = {0, 1, 2};
    p.limits.velocity = core::Velocity{300.0};
    p.limits.acceleration = core::Acceleration{3000.0};
    p.limits.deceleration = core::Acceleration{3000.0};
    p.limits.jerk = core::Jerk{60000.0};
    return p;
}

inline GroupCommand groupCommand(GroupCommandKind kind) {
    GroupCommand c;
    c.kind = kind;
    return c;
}
inline GroupCommand lineTo(const GroupPoint& point, double velocity = 100.0) {
    GroupCommand c = groupCommand(GroupCommandKind::MoveLinear);
    c.point = point;
    c.dynamics.velocity = core::Velocity{velocity};
    return c;
}
inline GroupCommand directTo(const GroupPoint& point) {
    GroupCommand c = groupCommand(GroupCommandKind::MoveDirect);
    c.point = point;
    return c;
}
inline GroupCommand arcTo(axis::CircMode mode, const GroupPoint& aux, const GroupPoint& end,
                          axis::CircPathChoice choice = axis::CircPathChoice::CounterClockwise) {
    GroupCommand c = groupCommand(GroupCommandKind::MoveCircular);
    c.arc = {mode, choice, 0.001, aux};
    c.point = end;
    c.dynamics.velocity = core::Velocity{100.0};
    return c;
}
inline GroupCommand buffered(GroupCommand c) {
    c.bufferMode = axis::BufferMode::Buffered;
    return c;
}
inline GroupCommand blended(GroupCommand c, double deviation) {
    c.bufferMode = axis::BufferMode::BlendingHigh;
    c.transition.mode = axis::TransitionMode::MaxCornerDeviation;
    c.transition.parameter = deviation;
    return c;
}
inline GroupCommand relative(GroupCommand c) {
    c.relative = true;
    return c;
}

/// Three axes with simulated drives and a group of them; plans are made between the cycles unless
/// `plannerSleeps`.
class GroupRig {
public:
    explicit GroupRig(const axis::GroupParams& params = testGroup(),
                      const axis::AxisParams& axisParams = testParams())
        : x{axisParams, Cycle},
          y{axisParams, Cycle},
          z{axisParams, Cycle},
          group{params, {&x, &y, &z}, Cycle},
          checks{ContinuityCheck{axisParams.limits, 0.001},
                 ContinuityCheck{axisParams.limits, 0.001},
                 ContinuityCheck{axisParams.limits, 0.001}} {
        for (std::size_t i = 0; i < 3; ++i)
            axes[i]->attach(drives[i].image(), SimDrive::bindings(), nullptr);
    }

    template <typename Program>
    void cycle(Program&& program) {
        ++k;
        for (SimDrive& drive : drives) drive.exchange();
        for (axis::Axis* axis : axes) axis->readInputs(k);
        group.readMembers(k);
        group.openPort(port);
        for (std::size_t i = 0; i < 3; ++i) axes[i]->openPort(*ports[i]);
        program();
        group.takeCommands(port);
        for (std::size_t i = 0; i < 3; ++i) axes[i]->takeCommands(*ports[i]);
        group.step();
        for (axis::Axis* axis : axes) axis->step();
        for (axis::Axis* axis : axes) axis->writeOutputs();
        if (!plannerSleeps && group.planner().wanted()) group.planner().work();
        check();
    }
    void cycle() {
        cycle([] {});
    }
    void cycles(int n) {
        for (int i = 0; i < n; ++i) cycle();
    }
    template <typename Condition>
    bool until(Condition&& condition, int limit = 20000) {
        for (int i = 0; i < limit && !condition(); ++i) cycle();
        return condition();
    }
    bool untilState(GroupState state, int limit = 20000) {
        return until([&] { return group.state() == state; }, limit);
    }

    axis::CommandId send(const GroupCommand& command) {
        axis::CommandId id{};
        cycle([&] {
            const auto r = port.submit(command);
            EXPECT_TRUE(r.ok()) << (r.ok() ? "" : axis::errorInfo(r.error()).name);
            if (r.ok()) id = r.value();
        });
        return id;
    }
    ErrorId refusal(const GroupCommand& command) {
        ErrorId error = ErrorId::None;
        cycle([&] {
            const auto r = port.submit(command);
            if (!r.ok()) error = r.error();
        });
        return error;
    }
    axis::CommandId sendAxis(std::size_t axis, const axis::Command& command) {
        axis::CommandId id{};
        cycle([&] {
            const auto r = ports[axis]->submit(command);
            EXPECT_TRUE(r.ok()) << (r.ok() ? "" : axis::errorInfo(r.error()).name);
            if (r.ok()) id = r.value();
        });
        return id;
    }
    ErrorId axisRefusal(std::size_t axis, const axis::Command& command) {
        ErrorId error = ErrorId::None;
        cycle([&] {
            const auto r = ports[axis]->submit(command);
            if (!r.ok()) error = r.error();
        });
        return error;
    }
    void powerOn() {
        cycle([&] {
            for (auto& p : ports) ASSERT_TRUE(p->submit(command(axis::CommandKind::PowerOn)).ok());
        });
        ASSERT_TRUE(until([&] {
            return x.state() == AxisState::Standstill && y.state() == AxisState::Standstill &&
                   z.state() == AxisState::Standstill;
        }));
    }
    void enable() { send(groupCommand(GroupCommandKind::Enable)); }
    void start() {
        powerOn();
        enable();
        ASSERT_EQ(group.state(), GroupState::Standby);
    }
    axis::CommandPhase phase(axis::CommandId id) const { return port.status(id).phase; }
    [[nodiscard]] GroupPoint set() const {
        GroupPoint point{};
        for (std::size_t i = 0; i < 3; ++i) point[i] = axes[i]->status().set.count();
        return point;
    }

    static constexpr core::Duration Cycle = std::chrono::milliseconds{1};
    std::array<SimDrive, 3> drives;
    axis::Axis x;
    axis::Axis y;
    axis::Axis z;
    std::array<axis::Axis*, 3> axes{&x, &y, &z};
    axis::Group group;
    axis::GroupPort port{1};
    axis::AxisPort portX{1}, portY{1}, portZ{1};
    std::array<axis::AxisPort*, 3> ports{&portX, &portY, &portZ};
    std::array<ContinuityCheck, 3> checks;
    std::uint64_t k{0};
    bool plannerSleeps{false};

private:
    void check() {
        for (std::size_t i = 0; i < 3; ++i) {
            const axis::AxisStatus s = axes[i]->status();
            if (!s.powered || s.mode != 8 || axes[i]->state() == AxisState::Disabled) {
                checks[i].restart();
            } else {
                checks[i].add(s.set.count(), k);
            }
        }
    }
};

}  // namespace takt::test
