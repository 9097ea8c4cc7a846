#include <gtest/gtest.h>

#include <cmath>
#include <takt/core/trigonometry.hpp>

namespace takt::core {
namespace {

constexpr double kUlp = 0x1p-53;

TEST(Trigonometry, SineAndCosineAreAccurate) {
    double worst = 0.0;
    for (int k = -200000; k <= 200000; ++k) {
        const double angle = k * 0.01234567 * (k % 7 == 0 ? 30.0 : 1.0);
        const SinCos at = sinCos(angle);
        const auto exact = static_cast<long double>(angle);
        worst = std::fmax(worst, static_cast<double>(std::fabs(at.sin - std::sin(exact))));
        worst = std::fmax(worst, static_cast<double>(std::fabs(at.cos - std::cos(exact))));
    }
    EXPECT_LE(worst, 1.2 * kUlp);
}

TEST(Trigonometry, QuarterTurnsAreExactUpToTheirRounding) {
    EXPECT_EQ(sinCos(0.0).sin, 0.0);
    EXPECT_EQ(sinCos(0.0).cos, 1.0);
    EXPECT_EQ(sinCos(0.5 * pi).sin, 1.0);
    EXPECT_NEAR(sinCos(0.5 * pi).cos, 6.123233995736766e-17, 1e-32);
    EXPECT_NEAR(sinCos(pi).sin, 1.2246467991473532e-16, 1e-31);
}

TEST(Trigonometry, HasNoAnswerForWhatIsNotFinite) {
    EXPECT_TRUE(std::isnan(sinCos(std::nan("")).sin));
    EXPECT_TRUE(std::isnan(sinCos(HUGE_VAL).cos));
}

TEST(Trigonometry, AngleOfIsTheInverse) {
    for (int k = -1000; k <= 1000; ++k) {
        const double angle = k * 0.00314;
        const double r = 0.001 + k * k;
        const double got = angleOf(r * std::cos(angle), r * std::sin(angle));
        EXPECT_NEAR(got, angle, 1e-15 * (1.0 + std::fabs(angle))) << angle;
    }
    EXPECT_EQ(angleOf(0.0, 0.0), 0.0);
    EXPECT_EQ(angleOf(-1.0, 0.0), pi);
    EXPECT_EQ(angleOf(0.0, -2.0), -0.5 * pi);
}

TEST(Trigonometry, CubeRootsAreAccurate) {
    for (int k = -60; k <= 60; ++k) {
        const double x = std::ldexp(1.0 + 0.013 * (k + 60), k);
        EXPECT_NEAR(cubeRoot(x) / static_cast<double>(std::cbrt(static_cast<long double>(x))), 1.0,
                    4.0 * kUlp);
        EXPECT_EQ(cubeRoot(-x), -cubeRoot(x));
    }
    EXPECT_EQ(cubeRoot(0.0), 0.0);
}

}  // namespace
}  // namespace takt::core
