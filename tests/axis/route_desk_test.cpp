#include <gtest/gtest.h>

#include <atomic>
#include <takt/axis/route_desk.hpp>
#include <thread>

namespace takt::axis {
namespace {

RouteDesk::Order orderOf(std::uint64_t seed) {
    RouteDesk::Order order;
    order.seed = seed;
    order.goal[0] = static_cast<double>(seed);
    return order;
}

TEST(RouteDesk, ServesNobodyUntilItIsTold) {
    RouteDesk desk;
    EXPECT_FALSE(desk.served());
    desk.serve(5);
    EXPECT_TRUE(desk.served());
}

TEST(RouteDesk, TakesOneOrderAtATime) {
    RouteDesk desk;
    desk.serve(5);
    const auto first = desk.ask(orderOf(1), 100);
    EXPECT_NE(first, RouteDesk::Ticket::None);
    EXPECT_EQ(desk.ask(orderOf(2), 101), RouteDesk::Ticket::None);
    EXPECT_TRUE(desk.owns(first));
    EXPECT_EQ(desk.order().seed, 1U);
}

TEST(RouteDesk, ThrowsAwayAnAnswerThatNobodyTookForTheNextOrder) {
    RouteDesk desk;
    desk.serve(5);
    const auto first = desk.ask(orderOf(1), 100);
    desk.finish({});
    const auto second = desk.ask(orderOf(2), 101);
    EXPECT_NE(second, RouteDesk::Ticket::None);
    EXPECT_FALSE(desk.owns(first));
    EXPECT_TRUE(desk.wanted());
    EXPECT_EQ(desk.answer(1000), nullptr);
}

TEST(RouteDesk, ShowsTheAnswerFromItsCycleOn) {
    RouteDesk desk;
    desk.serve(5);
    ASSERT_NE(desk.ask(orderOf(1), 100), RouteDesk::Ticket::None);
    desk.finish({});
    EXPECT_EQ(desk.answer(104), nullptr);
    EXPECT_NE(desk.answer(105), nullptr);
    EXPECT_NE(desk.answer(999), nullptr);
}

TEST(RouteDesk, TellsOfEachOrderOnce) {
    RouteDesk desk;
    desk.serve(5);
    EXPECT_FALSE(desk.takeCall());
    ASSERT_NE(desk.ask(orderOf(1), 100), RouteDesk::Ticket::None);
    EXPECT_TRUE(desk.takeCall());
    EXPECT_FALSE(desk.takeCall());
}

TEST(RouteDesk, HandsOrdersAndAnswersBetweenTwoThreads) {
    RouteDesk desk;
    desk.serve(1);
    constexpr std::uint64_t Orders = 2000;
    std::thread office{[&desk] {
        for (std::uint64_t answered = 0; answered < Orders;) {
            if (!desk.wanted()) {
                std::this_thread::yield();
                continue;
            }
            RouteDesk::Answer answer;
            answer.duration = static_cast<double>(desk.order().seed);
            answer.path.lineTo(desk.order().goal);
            desk.finish(answer);
            ++answered;
        }
    }};
    std::uint64_t good = 0;
    for (std::uint64_t seed = 1; seed <= Orders; ++seed) {
        ASSERT_NE(desk.ask(orderOf(seed), seed), RouteDesk::Ticket::None);
        const RouteDesk::Answer* answer = nullptr;
        while ((answer = desk.answer(seed + 1)) == nullptr) std::this_thread::yield();
        const auto expected = static_cast<double>(seed);
        good +=
            answer->duration == expected && answer->path.segments[0].point[0] == expected ? 1U : 0U;
    }
    office.join();
    EXPECT_EQ(good, Orders);
}

}  // namespace
}  // namespace takt::axis
