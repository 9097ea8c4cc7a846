#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <takt/axis/admit.hpp>

#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;
using axis::admit;
using axis::CommandKind;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Admit : testing::Test {
    Admit() {
        traits.limits = testParams().limits;
        traits.resolution = core::Distance{0.002};
        traits.maxPosition = core::Distance{4.5e12};
        traits.queueDepth = 2;
        view.traits = &traits;
        view.state = AxisState::Standstill;
        view.powerRequested = view.powered = true;
    }
    ErrorId judge(const axis::Command& c) const {
        const auto r = admit(view, c);
        return r.ok() ? ErrorId::None : r.error();
    }
    axis::AxisTraits traits;
    axis::AxisView view;
};

}  // namespace

TEST_F(Admit, FillsInTheAxisDefaultsForZero) {
    const auto r = admit(view, moveTo(10.0));
    ASSERT_TRUE(r.ok());
    EXPECT_EQ(r.value().dynamics.acceleration.count(), 5000.0);
    EXPECT_EQ(r.value().dynamics.deceleration.count(), 4000.0);
    EXPECT_EQ(r.value().dynamics.jerk.count(), 100000.0);
    const auto stop = admit(view, command(CommandKind::Stop));
    ASSERT_TRUE(stop.ok());
    EXPECT_EQ(stop.value().dynamics.deceleration.count(), 8000.0);
    EXPECT_EQ(stop.value().dynamics.jerk.count(), 400000.0);
    const auto halt = admit(view, command(CommandKind::Halt));
    ASSERT_TRUE(halt.ok());
    EXPECT_EQ(halt.value().dynamics.deceleration.count(), 4000.0);
}

TEST_F(Admit, RefusesDynamicsThatAreNegativeOrNotFinite) {
    for (const double bad : {-1.0, kNan, kInf, -kInf}) {
        auto c = moveTo(10.0);
        c.dynamics.acceleration = core::Acceleration{bad};
        EXPECT_EQ(judge(c), ErrorId::InvalidParameter) << bad;
        c = moveTo(10.0);
        c.dynamics.deceleration = core::Acceleration{bad};
        EXPECT_EQ(judge(c), ErrorId::InvalidParameter) << bad;
        c = moveTo(10.0);
        c.dynamics.jerk = core::Jerk{bad};
        EXPECT_EQ(judge(c), ErrorId::InvalidParameter) << bad;
        c = command(CommandKind::Stop);
        c.dynamics.deceleration = core::Acceleration{bad};
        EXPECT_EQ(judge(c), ErrorId::InvalidParameter) << bad;
    }
}

TEST_F(Admit, RefusesValuesAboveTheApplicationLimits) {
    EXPECT_EQ(judge(moveTo(10.0, 500.0)), ErrorId::None);
    EXPECT_EQ(judge(moveTo(10.0, 500.1)), ErrorId::LimitExceeded);
    EXPECT_EQ(judge(runAt(-500.1)), ErrorId::LimitExceeded);
    auto c = moveTo(10.0);
    c.dynamics.acceleration = core::Acceleration{5000.1};
    EXPECT_EQ(judge(c), ErrorId::LimitExceeded);
    c = moveTo(10.0);
    c.dynamics.deceleration = core::Acceleration{4000.1};
    EXPECT_EQ(judge(c), ErrorId::LimitExceeded);
    c = command(CommandKind::Stop);
    c.dynamics.deceleration = core::Acceleration{8000.0};
    EXPECT_EQ(judge(c), ErrorId::None);
    c.dynamics.deceleration = core::Acceleration{8000.1};
    EXPECT_EQ(judge(c), ErrorId::LimitExceeded);
    c = command(CommandKind::Halt);
    c.dynamics.deceleration = core::Acceleration{4000.1};
    EXPECT_EQ(judge(c), ErrorId::LimitExceeded);
}

TEST_F(Admit, RefusesPositionsThatAreNotFiniteOrHuge) {
    for (const double bad : {kNan, kInf, -kInf}) {
        EXPECT_EQ(judge(moveTo(bad)), ErrorId::NotFinite);
        EXPECT_EQ(judge(moveBy(bad)), ErrorId::NotFinite);
        EXPECT_EQ(judge(moveTo(1.0, bad)), ErrorId::NotFinite);
        EXPECT_EQ(judge(runAt(bad)), ErrorId::NotFinite);
    }
    EXPECT_EQ(judge(moveTo(1e300)), ErrorId::LimitExceeded);
    EXPECT_EQ(judge(moveBy(-1e300)), ErrorId::LimitExceeded);
    auto home = command(CommandKind::Home);
    home.position = core::Position{kNan};
    EXPECT_EQ(judge(home), ErrorId::NotFinite);
}

TEST_F(Admit, RefusesVelocityZeroForPositioningOnly) {
    EXPECT_EQ(judge(moveTo(10.0, 0.0)), ErrorId::InvalidParameter);
    EXPECT_EQ(judge(moveBy(10.0, 0.0)), ErrorId::InvalidParameter);
    EXPECT_EQ(judge(runAt(0.0)), ErrorId::None);
    EXPECT_EQ(judge(moveTo(10.0, -50.0)), ErrorId::None);
}

TEST_F(Admit, MultipliesTheSignsOfVelocityAndDirection) {
    auto c = runAt(-10.0);
    c.direction = axis::Direction::Negative;
    auto r = admit(view, c);
    ASSERT_TRUE(r.ok());
    EXPECT_EQ(r.value().dynamics.velocity.count(), 10.0);
    c.direction = axis::Direction::ShortestWay;
    EXPECT_EQ(judge(c), ErrorId::DirectionInvalid);
    c.direction = static_cast<axis::Direction>(9);
    EXPECT_EQ(judge(c), ErrorId::DirectionInvalid);
}

TEST_F(Admit, GivesTheSameAnswerForAnAdmittedCommand) {
    auto c = runAt(10.0);
    c.direction = axis::Direction::Negative;
    const auto once = admit(view, c);
    ASSERT_TRUE(once.ok());
    const auto twice = admit(view, once.value());
    ASSERT_TRUE(twice.ok());
    EXPECT_EQ(twice.value().dynamics.velocity.count(), -10.0);
}

TEST_F(Admit, KeepsTargetsInsideTheSoftwareLimits) {
    traits.limits.softNegative = core::Position{-10.0};
    traits.limits.softPositive = core::Position{100.0};
    EXPECT_EQ(judge(moveTo(100.0)), ErrorId::None);
    EXPECT_EQ(judge(moveTo(100.0001)), ErrorId::TargetOutsideSWLimit);
    EXPECT_EQ(judge(moveTo(-10.1)), ErrorId::TargetOutsideSWLimit);
    view.set = core::Position{95.0};
    EXPECT_EQ(judge(moveBy(5.0)), ErrorId::None);
    EXPECT_EQ(judge(moveBy(5.1)), ErrorId::TargetOutsideSWLimit);
}

TEST_F(Admit, LetsAnAxisAtALimitMoveInwardOnly) {
    traits.limits.softPositive = core::Position{100.0};
    for (const double at : {100.0, 130.0}) {
        view.set = core::Position{at};
        EXPECT_EQ(judge(runAt(1.0)), ErrorId::SWLimitReached);
        EXPECT_EQ(judge(runAt(-1.0)), ErrorId::None);
        EXPECT_EQ(judge(moveTo(90.0)), ErrorId::None);
    }
}

TEST_F(Admit, AnswersMotionByTheState) {
    const struct {
        AxisState state;
        ErrorId aborting;
        ErrorId queued;
        ErrorId stop;
        ErrorId home;
    } table[] = {
        {AxisState::Disabled, ErrorId::NotPowered, ErrorId::NotPowered, ErrorId::InvalidState,
         ErrorId::NotPowered},
        {AxisState::Standstill, ErrorId::None, ErrorId::None, ErrorId::None, ErrorId::None},
        {AxisState::Homing, ErrorId::InvalidState, ErrorId::None, ErrorId::None,
         ErrorId::InvalidState},
        {AxisState::DiscreteMotion, ErrorId::None, ErrorId::None, ErrorId::None,
         ErrorId::InvalidState},
        {AxisState::ContinuousMotion, ErrorId::None, ErrorId::None, ErrorId::None,
         ErrorId::InvalidState},
        {AxisState::Stopping, ErrorId::AxisLocked, ErrorId::AxisLocked, ErrorId::AxisLocked,
         ErrorId::AxisLocked},
        {AxisState::ErrorStop, ErrorId::AxisInErrorStop, ErrorId::AxisInErrorStop,
         ErrorId::InvalidState, ErrorId::AxisInErrorStop},
    };
    for (const auto& row : table) {
        view.state = row.state;
        EXPECT_EQ(judge(moveTo(1.0)), row.aborting) << axis::name(row.state);
        EXPECT_EQ(judge(command(CommandKind::Halt)), row.aborting) << axis::name(row.state);
        EXPECT_EQ(judge(buffered(moveTo(1.0))), row.queued) << axis::name(row.state);
        EXPECT_EQ(judge(command(CommandKind::Stop)), row.stop) << axis::name(row.state);
        EXPECT_EQ(judge(command(CommandKind::Home)), row.home) << axis::name(row.state);
    }
}

TEST_F(Admit, RefusesBlendingOfMotionThatHasNoEnd) {
    auto c = moveTo(1.0);
    c.bufferMode = axis::BufferMode::BlendingLow;
    EXPECT_EQ(judge(c), ErrorId::None);
    view.tailEndless = true;
    EXPECT_EQ(judge(c), ErrorId::None);  // of what has ended
    view.state = AxisState::ContinuousMotion;
    EXPECT_EQ(judge(c), ErrorId::BlendingNotPossible);
    EXPECT_EQ(judge(buffered(moveTo(1.0))), ErrorId::None);
    auto home = command(CommandKind::Home);
    view.state = AxisState::DiscreteMotion;
    view.tailEndless = false;
    home.bufferMode = axis::BufferMode::BlendingNext;
    EXPECT_EQ(judge(home), ErrorId::BlendingNotPossible);
    c.bufferMode = static_cast<axis::BufferMode>(6);
    EXPECT_EQ(judge(c), ErrorId::InvalidParameter);
}

TEST_F(Admit, RefusesWhenTheQueueIsFull) {
    view.state = AxisState::DiscreteMotion;
    view.queued = 1;
    EXPECT_EQ(judge(buffered(moveTo(1.0))), ErrorId::None);
    view.queued = 2;
    EXPECT_EQ(judge(buffered(moveTo(1.0))), ErrorId::BufferFull);
    EXPECT_EQ(judge(moveTo(1.0)), ErrorId::None);
}

TEST(ErrorTable, HasStableNumbersInAscendingOrderWithTextAndRemedy) {
    unsigned last = 0;
    for (const auto& e : axis::allErrors()) {
        if (e.id == ErrorId::None) continue;
        EXPECT_GT(static_cast<unsigned>(e.id), last) << e.name;
        last = static_cast<unsigned>(e.id);
        EXPECT_STRNE(e.text, "");
        EXPECT_STRNE(e.remedy, "");
        EXPECT_EQ(axis::errorInfo(e.id).name, e.name);
    }
    EXPECT_EQ(static_cast<unsigned>(ErrorId::NotFinite), 0x010BU);
    EXPECT_EQ(static_cast<unsigned>(ErrorId::ResetFailed), 0x0804U);
    EXPECT_STREQ(axis::errorInfo(static_cast<ErrorId>(0xFFFF)).name, "Unknown");
}

TEST(ErrorTable, ExplainsARecordWithItsNumbers) {
    const axis::ErrorRecord record{ErrorId::LagExceeded, 0x8611, 42, {1.5, 1.0, 7.25}};
    const std::string text = axis::explain(record);
    EXPECT_NE(text.find("LagExceeded (0x0601) in cycle 42"), std::string::npos) << text;
    EXPECT_NE(text.find("lag: 1.5"), std::string::npos) << text;
    EXPECT_NE(text.find("0x8611"), std::string::npos) << text;
}
