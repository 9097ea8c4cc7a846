#include <cmath>
#include <takt/core/trigonometry.hpp>

namespace takt::core {

namespace {

/// pi/2 in three parts of 33 bits and a rest: a multiple by less than 2^20 of the first three is
/// exact, so the reduction loses nothing.
constexpr double kHalfPi1 = 0x1.921fb544p+0;
constexpr double kHalfPi2 = 0x1.0b4611a6p-34;
constexpr double kHalfPi3 = 0x1.3198a2e0p-69;
constexpr double kHalfPi4 = 0x1.b839a252049c1p-104;

/// Taylor series on [-pi/4, pi/4]: the first term left out is below 1e-19. `tail` is what the
/// angle's rounding lost.
double sinNear(double x, double tail) noexcept {
    const double z = x * x;
    double p = 1.0 / 355687428096000.0;
    p = -1.0 / 1307674368000.0 + z * p;
    p = 1.0 / 6227020800.0 + z * p;
    p = -1.0 / 39916800.0 + z * p;
    p = 1.0 / 362880.0 + z * p;
    p = -1.0 / 5040.0 + z * p;
    p = 1.0 / 120.0 + z * p;
    p = -1.0 / 6.0 + z * p;
    return x + (x * z * p + tail * (1.0 - 0.5 * z));
}

double cosNear(double x, double tail) noexcept {
    const double z = x * x;
    double p = -1.0 / 6402373705728000.0;
    p = 1.0 / 20922789888000.0 + z * p;
    p = -1.0 / 87178291200.0 + z * p;
    p = 1.0 / 479001600.0 + z * p;
    p = -1.0 / 3628800.0 + z * p;
    p = 1.0 / 40320.0 + z * p;
    p = -1.0 / 720.0 + z * p;
    p = 1.0 / 24.0 + z * p;
    // 1 - z/2 rounds; what it loses goes in with the small terms.
    const double half = 0.5 * z;
    const double head = 1.0 - half;
    return head + (((1.0 - head) - half) + (z * z * p - x * tail));
}

}  // namespace

SinCos sinCos(double angle) noexcept {
    const double turns = angle * (2.0 / pi);
    if (!(std::fabs(turns) < 0x1p51)) {
        return {std::nan(""), std::nan("")};
    }
    // Adding and taking away 1.5 * 2^52 rounds to the nearest whole number.
    constexpr double kRound = 0x1.8p52;
    const double k = (turns + kRound) - kRound;
    const double a = angle - k * kHalfPi1;
    const double b = k * kHalfPi2;
    const double c = a - b;
    const double lost = (a - c) - b;
    const double d = k * kHalfPi3 + k * kHalfPi4 - lost;
    const double x = c - d;
    const double tail = (c - x) - d;
    const double s = sinNear(x, tail);
    const double o = cosNear(x, tail);
    switch (static_cast<long long>(k) & 3) {
        case 0:
            return {s, o};
        case 1:
            return {o, -s};
        case 2:
            return {-s, -o};
    }
    return {-o, s};
}

double angleOf(double x, double y) noexcept {
    const double ax = std::fabs(x);
    const double ay = std::fabs(y);
    const double most = ax > ay ? ax : ay;
    if (!(most > 0.0)) return most == 0.0 ? 0.0 : std::nan("");
    // In the first octant a quadratic in the ratio is good to 0.004; two steps of third order do
    // the rest.
    const double ratio = (ax > ay ? ay : ax) / most;
    double angle = ratio * (1.0584 - 0.273 * ratio);
    const double length = std::sqrt(1.0 + ratio * ratio);
    for (int i = 0; i < 2; ++i) {
        const SinCos at = sinCos(angle);
        const double d = (ratio * at.cos - at.sin) / length;
        angle += d * (1.0 + d * d / 6.0);
    }
    if (ay > ax) angle = 0.5 * pi - angle;
    if (x < 0.0) angle = pi - angle;
    return y < 0.0 ? -angle : angle;
}

double cubeRoot(double x) noexcept {
    if (x == 0.0 || !std::isfinite(x)) return x;
    int exponent = 0;
    double m = std::frexp(std::fabs(x), &exponent);
    int rest = exponent % 3;
    if (rest < 0) rest += 3;
    m = std::ldexp(m, rest);  // in [0.5, 4)
    double r = 0.6 + m * (0.415 - m * 0.0325);
    for (int i = 0; i < 4; ++i) r -= (r * r * r - m) / (3.0 * r * r);
    return std::copysign(std::ldexp(r, (exponent - rest) / 3), x);
}

}  // namespace takt::core
