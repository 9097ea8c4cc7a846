#include <gmock/gmock.h>

#include <concepts>
#include <takt/core/time.hpp>
#include <takt/core/units.hpp>
#include <type_traits>

namespace {

using namespace takt::core;

template <typename A, typename B>
concept Addable = requires(A a, B b) {
    a + b;
};
template <typename A, typename B>
concept Subtractable = requires(A a, B b) {
    a - b;
};

TEST(Units, DivideAndMultiplyToTheRightKind) {
    static_assert(std::same_as<decltype(Distance{1} / Seconds{1}), Velocity>);
    static_assert(std::same_as<decltype(Velocity{1} / Seconds{1}), Acceleration>);
    static_assert(std::same_as<decltype(Jerk{1} * Seconds{1}), Acceleration>);
    EXPECT_EQ((Distance{6} / Seconds{2}).count(), 3.0);
    EXPECT_EQ((Velocity{6} * Seconds{2}).count(), 12.0);
}

TEST(Units, DoNotMix) {
    static_assert(!std::convertible_to<Distance, Velocity>);
    static_assert(!std::convertible_to<double, Velocity>);
    static_assert(!Addable<Distance, Velocity>);
    static_assert(!Addable<Position, Position>);
    static_assert(Subtractable<Position, Position>);
    static_assert(!std::convertible_to<HostTime, DcTime>);
    static_assert(!Subtractable<HostTime, TrueTime>);
}

TEST(Units, PositionsSubtractToADistance) {
    static_assert(std::same_as<decltype(Position{3} - Position{1}), Distance>);
    EXPECT_EQ((Position{3} - Position{1}).count(), 2.0);
    EXPECT_EQ((Position{3} + Distance{1}).count(), 4.0);
    EXPECT_EQ((Position{3} - Distance{1}).count(), 2.0);
}

TEST(Units, AreAsSmallAsADouble) {
    static_assert(sizeof(Velocity) == sizeof(double) && sizeof(Position) == sizeof(double));
    static_assert(std::is_trivially_copyable_v<Velocity>);
}

TEST(Units, Accumulate) {
    Distance d{1};
    d += Distance{2};
    d -= Distance{0.5};
    EXPECT_EQ(d, Distance{2.5});
    EXPECT_EQ(-d, Distance{-2.5});
    EXPECT_EQ(2.0 * d, d * 2.0);
    EXPECT_EQ((d / 2.0).count(), 1.25);
    EXPECT_LT(Distance{1}, Distance{2});
}

}  // namespace
