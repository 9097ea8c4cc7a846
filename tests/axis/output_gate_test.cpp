#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <new>
#include <takt/axis/output_gate.hpp>

#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;
using axis::OutputGate;
using Verdict = axis::OutputGate::Verdict;

namespace takt::axis {

/// Puts nonsense where only a bug could put it.
struct AxisTestAccess {
    static void poison(Axis& axis, double jump) {
        planner::State s = axis.motion_.set();
        s.position = core::Position{s.position.count() + jump};
        axis.motion_.profile_ = planner::Profile::holding(s);
        axis.motion_.step_ = 0;
        axis.motion_.steps_ = 1;
        axis.motion_.resting_ = false;
    }
};

}  // namespace takt::axis

namespace {

axis::AxisTraits traits() {
    axis::AxisTraits t;
    t.limits = testParams().limits;  // 500 mm/s, 8000 mm/s² at most
    t.resolution = core::Distance{0.002};
    t.maxPosition = core::Distance{1e6};
    return t;
}

core::Position at(double x) {
    return core::Position{x};
}

}  // namespace

TEST(OutputGate, RefusesWhatIsNotFinite) {
    const auto t = traits();
    OutputGate gate{t, std::chrono::milliseconds{1}};
    gate.prime(at(0.0));
    EXPECT_EQ(gate.judge(at(std::numeric_limits<double>::quiet_NaN())), Verdict::NotFinite);
    EXPECT_EQ(gate.judge(at(std::numeric_limits<double>::infinity())), Verdict::NotFinite);
    EXPECT_EQ(gate.judge(at(-std::numeric_limits<double>::infinity())), Verdict::NotFinite);
}

TEST(OutputGate, RefusesWhatCountsCannotExpress) {
    const auto t = traits();
    OutputGate gate{t, std::chrono::milliseconds{1}};
    gate.prime(at(999999.999));
    EXPECT_EQ(gate.judge(at(1000000.001)), Verdict::OutOfRange);
}

TEST(OutputGate, RefusesAVelocityStep) {
    const auto t = traits();
    OutputGate gate{t, std::chrono::milliseconds{1}};
    gate.prime(at(0.0));
    // Speed up by 8000 mm/s² · T² = 0.008 mm a cycle each cycle.
    double x = 0.0;
    for (int n = 1; 0.008 * n <= 0.5; ++n) {
        x += 0.008 * n;
        ASSERT_EQ(gate.judge(at(x)), Verdict::Pass) << n;
        gate.accept(at(x));
    }
    EXPECT_EQ(gate.judge(at(x + 0.5)), Verdict::Pass);
    EXPECT_EQ(gate.judge(at(x + 0.5001)), Verdict::VelocityStep);
}

TEST(OutputGate, RefusesAnAccelerationStep) {
    const auto t = traits();
    OutputGate gate{t, std::chrono::milliseconds{1}};
    gate.prime(at(10.0));
    EXPECT_EQ(gate.judge(at(10.008)), Verdict::Pass);
    EXPECT_EQ(gate.judge(at(10.00801)), Verdict::AccelerationStep);
    EXPECT_EQ(gate.judge(at(9.99199)), Verdict::AccelerationStep);
}

TEST(OutputGate, BrakesFromTheLastGoodStepToRest) {
    const auto t = traits();
    OutputGate gate{t, std::chrono::milliseconds{1}};
    gate.prime(at(0.0));
    double x = 0.0;
    for (int n = 1; n <= 50; ++n) gate.accept(at(x += 0.008 * n));
    int n = 0;
    while (gate.lastStep().count() != 0.0 && n < 1000) {
        const auto p = gate.braked();
        ASSERT_EQ(gate.judge(p), Verdict::Pass);
        gate.accept(p);
        ++n;
    }
    EXPECT_LE(n, 51);
}

TEST(OutputGate, BadValueNeverLeavesTheAxis) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1.0, -0.1, 1e9}) {
        Rig rig;
        rig.powerOn();
        const auto id = rig.send(moveTo(200.0, 400.0));
        rig.cycles(200);
        const double last = rig.x.status().set.count();
        axis::AxisTestAccess::poison(rig.x, bad);
        rig.cycle();  // the rig checks that nothing jumps
        EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
        EXPECT_EQ(rig.x.error().id, ErrorId::SetpointJump);
        EXPECT_EQ(rig.x.error().numbers[1], last);
        EXPECT_EQ(rig.x.error().numbers[2], static_cast<double>(axis::CommandKind::MoveAbsolute));
        ASSERT_TRUE(rig.until([&] { return rig.x.isStopped(); }, 500));
        rig.cycle();
        EXPECT_EQ(rig.status(id).error, ErrorId::SetpointJump);
        EXPECT_TRUE(rig.x.status().powered);
        EXPECT_GT(rig.x.status().set.count(), last);
    }
}
