#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <new>
#include <takt/planner/cyclic.hpp>
#include <takt/planner/path_brake.hpp>
#include <takt/planner/position_range.hpp>
#include <takt/planner/tracker.hpp>
#include <vector>

#include "problems.hpp"

namespace {

thread_local int allocations = 0;

void* counted(std::size_t size) {
    ++allocations;
    void* memory = std::malloc(size != 0 ? size : 1);
    if (memory == nullptr) throw std::bad_alloc{};
    return memory;
}

}  // namespace

void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace takt::planner {
namespace {

using core::Seconds;
using test::Random;

TEST(Allocation, IsCountedHere) {
    const int before = allocations;
    const std::vector<int> some(100);
    EXPECT_EQ(some.size(), 100U);
    EXPECT_GT(allocations, before);
}

TEST(Allocation, HappensNeitherInPlanningNorInSampling) {
    Random random{41};
    CyclicGenerator generator{3, Seconds{0.01}};
    Trajectory trajectory{3};
    std::array<AxisRequest, 3> requests{};
    std::array<Goal, 3> goals{};
    std::array<State, 3> states{};
    const int before = allocations;
    for (int i = 0; i < 300; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto c = i % 2 == 0 ? test::ordinary(random) : test::outside(random);
            requests[k] = {c.from, c.target, c.limits};
            goals[k] = {c.target, c.limits};
        }
        Timing timing;
        timing.synchronisation = static_cast<Synchronisation>(i % 5);
        timing.cycle = Seconds{i % 3 == 0 ? 0.01 : 0.0};
        ASSERT_TRUE(trajectory.plan(requests, timing).ok());
        trajectory.sample(trajectory.duration() * 0.5, states);
        static_cast<void>(generator.step(goals, timing, states));
        const auto& r = requests[0];
        static_cast<void>(
            planWithin(r.from, r.target, r.limits, {core::Position{-9}, core::Position{9}}));
        Tracker tracker{r.limits, Seconds{0.01}};
        tracker.reset(r.from);
        static_cast<void>(tracker.step(r.target.state, states[0]));
    }
    EXPECT_EQ(allocations, before);
}

TEST(Allocation, HappensNeitherInFollowingAPathNorInBraking) {
    const std::array<PathAxisLimits, 2> limits{
        {{core::Velocity{100.0}, core::Acceleration{2000.0}, core::Jerk{50000.0}},
         {core::Velocity{100.0}, core::Acceleration{2000.0}, core::Jerk{50000.0}}}};
    const PathSpace space{2, 2};
    PathPoint corner{};
    corner[0] = core::Position{20.0};
    PathPoint end = corner;
    end[1] = core::Position{20.0};
    std::vector<PathElement> elements{line(space, PathPoint{}, corner).value(),
                                      line(space, corner, end).value()};
    elements[0].transition = {TransitionMode::CornerDeviation, core::Distance{0.1}};
    PathPlanner planner{space, limits, Seconds{0.001}};
    PathMotion motion = planner.motion();
    ASSERT_TRUE(planner.plan(elements, motion).ok());
    std::array<PathAxisState, 2> states{};
    const int before = allocations;
    for (std::uint64_t k = 0; k <= motion.feed.cycles(); ++k) {
        axesAt(motion.geometry, motion.feed.at(k), states);
        PathBrake brake;
        brake.start(motion, k, limits, {});
        for (int n = 0; n < 5; ++n) static_cast<void>(brake.step());
    }
    EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace takt::planner
