#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <takt/axis/axis.hpp>

#include "sim_drive.hpp"

namespace takt::test {

using axis::AxisState;
using axis::ErrorId;

/// 10000 counts per 20 mm: 0.002 mm a count. 1 ms cycle.
inline axis::AxisParams testParams() {
    axis::AxisParams p;
    p.name = "X";
    p.unit = "mm";
    p.scaling.countsPerTurn = 10000;
    p.scaling.unitsPerTurnNumerator = 20;
    p.limits.velocity = core::Velocity{500.0};
    p.limits.acceleration = core::Acceleration{5000.0};
    p.limits.deceleration = core::Acceleration{4000.0};
    p.limits.jerk = core::Jerk{100000.0};
    p.limits.stopDeceleration = core::Acceleration{8000.0};
    p.limits.stopJerk = core::Jerk{400000.0};
    p.supervision.followingError = core::Distance{1.0};
    p.supervision.driveDelayCycles = 1;
    return p;
}

/// First, second and third differences of the set position against the axis' limits, cycle by
/// cycle. It knows nothing of how the set position came about.
class ContinuityCheck {
public:
    ContinuityCheck(const axis::LimitParams& limits, double cycle)
        : v_{limits.velocity.count() * cycle},
          a_{std::max({limits.acceleration.count(), limits.deceleration.count(),
                       limits.stopDeceleration.count()}) *
             cycle * cycle},
          j_{std::max(limits.jerk.count(), limits.stopJerk.count()) * cycle * cycle * cycle} {}

    void restart() { known_ = 0; }

    void add(double set, std::uint64_t cycle) {
        const double slack = 16.0 * std::numeric_limits<double>::epsilon() * std::abs(set);
        ASSERT_TRUE(std::isfinite(set)) << "cycle " << cycle;
        const double d1 = set - last_;
        const double d2 = d1 - lastStep_;
        const double d3 = d2 - lastChange_;
        const double tolerant = 1.0 + 1e-6;
        if (known_ >= 1) {
            EXPECT_LE(std::abs(d1), v_ * tolerant + slack) << "cycle " << cycle;
        }
        if (known_ >= 2) {
            EXPECT_LE(std::abs(d2), a_ * tolerant + slack) << "cycle " << cycle;
        }
        if (known_ >= 3) {
            EXPECT_LE(std::abs(d3), j_ * tolerant + slack) << "cycle " << cycle;
        }
        lastChange_ = known_ >= 2 ? d2 : 0.0;
        lastStep_ = known_ >= 1 ? d1 : 0.0;
        last_ = set;
        ++known_;
    }

private:
    double v_;
    double a_;
    double j_;
    double last_{0.0};
    double lastStep_{0.0};
    double lastChange_{0.0};
    int known_{0};
};

/// One axis, one simulated drive, one program.
class Rig {
public:
    explicit Rig(const axis::AxisParams& params = testParams(),
                 core::Duration cycle = std::chrono::milliseconds{1})
        : x{params, cycle},
          continuity{params.limits, std::chrono::duration<double>(cycle).count()} {
        x.attach(drive.image(), SimDrive::bindings(), nullptr);
    }

    /// One bus cycle with `program` as the user program.
    template <typename Program>
    void cycle(Program&& program) {
        ++k;
        drive.exchange();
        x.readInputs(k);
        x.openPort(port);
        program();
        x.takeCommands(port);
        x.step();
        x.writeOutputs();
        check();
    }
    void cycle() {
        cycle([] {});
    }
    void cycles(int n) {
        for (int i = 0; i < n; ++i) cycle();
    }
    /// Runs until `condition` holds at the end of a cycle. \return false when it never did
    template <typename Condition>
    bool until(Condition&& condition, int limit = 20000) {
        for (int i = 0; i < limit; ++i) {
            if (condition()) return true;
            cycle();
        }
        return condition();
    }
    bool untilState(AxisState state, int limit = 20000) {
        return until([&] { return x.state() == state; }, limit);
    }

    axis::CommandId send(const axis::Command& command) {
        axis::CommandId id{};
        cycle([&] {
            const auto r = port.submit(command);
            EXPECT_TRUE(r.ok()) << (r.ok() ? "" : axis::errorInfo(r.error()).name);
            if (r.ok()) id = r.value();
        });
        return id;
    }
    ErrorId refusal(const axis::Command& command) {
        ErrorId error = ErrorId::None;
        cycle([&] {
            const auto r = port.submit(command);
            if (!r.ok()) error = r.error();
        });
        return error;
    }
    void powerOn() {
        axis::Command on;
        on.kind = axis::CommandKind::PowerOn;
        send(on);
        ASSERT_TRUE(untilState(AxisState::Standstill, 100));
    }
    axis::CommandStatus status(axis::CommandId id) const { return port.status(id); }

    SimDrive drive;
    axis::Axis x;
    axis::AxisPort port{1};
    ContinuityCheck continuity;
    std::uint64_t k{0};

private:
    void check() {
        const axis::AxisStatus s = x.status();
        const bool led = s.powered && s.mode == 8 && x.state() != AxisState::Homing &&
                         x.state() != AxisState::Disabled;
        if (!led) {
            continuity.restart();
            return;
        }
        continuity.add(s.set.count(), k);
        // What leaves is the set position in counts, to the half count of rounding.
        const double counts =
            (s.set - x.scaling().toUnits(0)).count() / x.traits().resolution.count();
        const auto folded = static_cast<std::int32_t>(
            static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::llround(counts))));
        EXPECT_LE(std::abs(static_cast<std::int64_t>(folded) - s.target), 1) << "cycle " << k;
    }
};

inline axis::Command moveTo(double position, double velocity = 100.0) {
    axis::Command c;
    c.kind = axis::CommandKind::MoveAbsolute;
    c.position = core::Position{position};
    c.dynamics.velocity = core::Velocity{velocity};
    return c;
}
inline axis::Command moveBy(double distance, double velocity = 100.0) {
    axis::Command c;
    c.kind = axis::CommandKind::MoveRelative;
    c.distance = core::Distance{distance};
    c.dynamics.velocity = core::Velocity{velocity};
    return c;
}
inline axis::Command runAt(double velocity) {
    axis::Command c;
    c.kind = axis::CommandKind::MoveVelocity;
    c.direction = axis::Direction::Positive;
    c.dynamics.velocity = core::Velocity{velocity};
    return c;
}
inline axis::Command command(axis::CommandKind kind) {
    axis::Command c;
    c.kind = kind;
    return c;
}
inline axis::Command buffered(axis::Command c) {
    c.bufferMode = axis::BufferMode::Buffered;
    return c;
}

}  // namespace takt::test
