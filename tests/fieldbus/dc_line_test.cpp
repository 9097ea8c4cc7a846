#include "dc_line.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <vector>

namespace {

using namespace takt;
using fieldbus::ethercat::gridAtOrAfter;
using fieldbus::ethercat::phaseError;
using fieldbus::ethercat::PortTimes;
using fieldbus::ethercat::propagationDelays;

/// An independent model: a frame is walked through a tree of devices in true time, and each device
/// notes its own (offset) clock whenever the frame arrives at a port.
struct Device {
    bool dc{true};
    std::uint32_t clock{0};   ///< local clock minus true time
    std::int64_t cable{100};  ///< one way, between this device and its parent
    std::vector<std::pair<std::uint8_t, int>> children;  ///< port and device, any order
};

class Walk {
public:
    explicit Walk(std::vector<Device> devices)
        : devices_{std::move(devices)}, times_(devices_.size()), arrival_(devices_.size()) {}

    void run(std::int64_t start) { visit(0, start); }

    std::int64_t visit(int which, std::int64_t now) {
        const Device& device = devices_[static_cast<std::size_t>(which)];
        PortTimes& mine = times_[static_cast<std::size_t>(which)];
        order.push_back(which);
        arrival_[static_cast<std::size_t>(which)] = now;
        note(mine, device, 0, now);
        mine.dc = device.dc;
        for (const std::uint8_t port : {std::uint8_t{3}, std::uint8_t{1}, std::uint8_t{2}}) {
            for (const auto& [childPort, child] : device.children) {
                if (childPort != port) continue;
                const std::int64_t cable = devices_[static_cast<std::size_t>(child)].cable;
                now = visit(child, now + Forward + cable) + Forward + cable;
                note(mine, device, port, now);
            }
        }
        return now;
    }
    [[nodiscard]] std::vector<PortTimes> inFrameOrder() const {
        std::vector<PortTimes> listed;
        for (const int which : order) listed.push_back(times_[static_cast<std::size_t>(which)]);
        return listed;
    }
    [[nodiscard]] std::int64_t arrival(std::size_t position) const {
        return arrival_[static_cast<std::size_t>(order[position])];
    }
    std::vector<int> order;

private:
    static constexpr std::int64_t Forward = 250;

    static void note(PortTimes& times, const Device& device, std::uint8_t port, std::int64_t now) {
        times.openPorts = static_cast<std::uint8_t>(times.openPorts | (1U << port));
        times.at[port] = static_cast<std::uint32_t>(now) + device.clock;
    }

    std::vector<Device> devices_;
    std::vector<PortTimes> times_;
    std::vector<std::int64_t> arrival_;
};

void expectTrueDelays(const Walk& walk, std::size_t reference) {
    const auto delays = propagationDelays(walk.inFrameOrder());
    for (std::size_t i = reference; i < delays.size(); ++i) {
        if (!walk.inFrameOrder()[i].dc) continue;
        const std::int64_t expected = walk.arrival(i) - walk.arrival(reference);
        EXPECT_NEAR(static_cast<double>(delays[i]), static_cast<double>(expected), 1.0)
            << "position " << i;
    }
}

TEST(DcDelay, IsTheTimeOfFlightAlongALine) {
    Walk walk{{{true, 0, 0, {{1, 1}}},
               {true, 0x12345678, 120, {{1, 2}}},
               {true, 99, 500, {{1, 3}}},
               {true, 7, 30, {}}}};
    walk.run(1'000'000);
    expectTrueDelays(walk, 0);
    EXPECT_EQ(propagationDelays(walk.inFrameOrder())[1], 370U);
}

TEST(DcDelay, SurvivesTheWrapOfTheLocalClocks) {
    Walk walk{{{true, 0xFFFFFF00, 0, {{1, 1}}},
               {true, 0xFFFFFE00, 200, {{1, 2}}},
               {true, 0xFFFFFD80, 300, {}}}};
    walk.run(100);
    expectTrueDelays(walk, 0);
}

TEST(DcDelay, FollowsBranchesInTheOrderOfThePorts) {
    Walk walk{{{true, 5, 0, {{1, 1}, {3, 2}, {2, 3}}},
               {true, 17, 100, {{1, 4}}},
               {true, 1000, 250, {{1, 5}}},
               {true, 333, 90, {}},
               {true, 77, 60, {}},
               {true, 4242, 10, {}}}};
    walk.run(50'000);
    EXPECT_THAT(walk.order, testing::ElementsAre(0, 2, 5, 1, 4, 3));
    expectTrueDelays(walk, 0);
}

TEST(DcDelay, PassesThroughADeviceWithoutClock) {
    Walk walk{{{true, 5, 0, {{1, 1}}},
               {false, 0, 100, {{1, 2}}},
               {true, 44, 160, {{1, 3}}},
               {true, 9, 70, {}}}};
    walk.run(50'000);
    expectTrueDelays(walk, 0);
}

TEST(DcDelay, StartsAtTheFirstDeviceWithAClock) {
    Walk walk{{{false, 0, 0, {{1, 1}}}, {true, 3, 100, {{1, 2}}}, {true, 44, 160, {}}}};
    walk.run(50'000);
    const auto delays = propagationDelays(walk.inFrameOrder());
    EXPECT_EQ(delays[0], 0U);
    EXPECT_EQ(delays[1], 0U);
    expectTrueDelays(walk, 1);
}

TEST(DcDelay, IsZeroForASingleDevice) {
    Walk walk{{{true, 5, 0, {}}}};
    walk.run(1);
    EXPECT_THAT(propagationDelays(walk.inFrameOrder()), testing::ElementsAre(0U));
}

TEST(DcDelay, NeverLoopsOnPortsThatContradictEachOther) {
    std::vector<PortTimes> nonsense(4);
    for (auto& device : nonsense) {
        device.dc = true;
        device.openPorts = 1;
    }
    EXPECT_THAT(propagationDelays(nonsense), testing::ElementsAre(0U, 0U, 0U, 0U));
}

core::DcTime dc(std::int64_t ns) {
    return core::DcTime{core::Duration{ns}};
}

TEST(DcGrid, RoundsUpToTheNextInstant) {
    const core::Duration ms{1'000'000};
    EXPECT_EQ(gridAtOrAfter(dc(5'000'000), ms), dc(5'000'000));
    EXPECT_EQ(gridAtOrAfter(dc(5'000'001), ms), dc(6'000'000));
    EXPECT_EQ(gridAtOrAfter(dc(5'999'999), ms), dc(6'000'000));
}

TEST(DcGrid, FoldsThePhaseErrorToHalfACycle) {
    const core::Duration cycle{1'000'000};
    const core::Duration ahead{250'000};
    EXPECT_EQ(phaseError(dc(7'750'000), ahead, cycle).count(), 0);
    EXPECT_EQ(phaseError(dc(7'760'000), ahead, cycle).count(), 10'000);
    EXPECT_EQ(phaseError(dc(7'740'000), ahead, cycle).count(), -10'000);
    EXPECT_EQ(phaseError(dc(8'249'999), ahead, cycle).count(), 499'999);
    EXPECT_EQ(phaseError(dc(8'250'000), ahead, cycle).count(), -500'000);
}

}  // namespace
