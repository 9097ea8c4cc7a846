#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "group_rig.hpp"

namespace takt::test {
namespace {

using axis::CommandPhase;

/// Goes round a corner and is stopped; the set positions of every cycle.
std::vector<GroupPoint> run(GroupRig& rig, const std::function<void()>& betweenCycles) {
    std::vector<GroupPoint> positions;
    rig.start();
    axis::CommandId last{};
    const auto cycle = [&](auto&& program) {
        rig.cycle(program);
        betweenCycles();
        positions.push_back(rig.set());
    };
    cycle([&] {
        static_cast<void>(rig.port.submit(lineTo({20.0, 0.0, 0.0})));
        static_cast<void>(rig.port.submit(blended(lineTo({20.0, 20.0, 0.0}), 0.2)));
    });
    for (int i = 0; i < 60; ++i) cycle([] {});
    cycle([&] { last = rig.port.submit(lineTo({0.0, 0.0, 0.0})).value(); });
    while (rig.phase(last) != CommandPhase::Done && positions.size() < 5000) cycle([] {});
    EXPECT_EQ(rig.phase(last), CommandPhase::Done);
    return positions;
}

TEST(Group, MovesTheSameWhetherItsPathsArePlannedInlineOrOnAnotherThread) {
    GroupRig alone;
    const auto expected = run(alone, [] {});

    GroupRig rig;
    rig.plannerSleeps = true;
    std::atomic<bool> over{false};
    std::thread planner{[&] {
        while (!over.load()) {
            if (rig.group.planner().wanted()) rig.group.planner().work();
            std::this_thread::yield();
        }
    }};
    const auto found = run(rig, [&] {
        while (rig.group.planner().wanted()) std::this_thread::yield();
    });
    over.store(true);
    planner.join();
    EXPECT_EQ(found, expected);
    EXPECT_EQ(rig.group.status().latePlans, 0U);
}

}  // namespace
}  // namespace takt::test
