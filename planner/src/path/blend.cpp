#include <algorithm>
#include <cmath>
#include <takt/planner/path_blend.hpp>

namespace takt::planner {

namespace {

using Coefficients = std::array<double, 6>;

/// Value and derivatives of a polynomial of fifth degree.
struct Taylor {
    double f;
    double f1;
    double f2;
    double f3;
};

Taylor taylor(const Coefficients& c, double u) noexcept {
    return {c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5])))),
            c[1] + u * (2.0 * c[2] + u * (3.0 * c[3] + u * (4.0 * c[4] + u * 5.0 * c[5]))),
            2.0 * c[2] + u * (6.0 * c[3] + u * (12.0 * c[4] + u * 20.0 * c[5])),
            6.0 * c[3] + u * (24.0 * c[4] + u * 60.0 * c[5])};
}

struct End {
    double f;
    double f1;
    double f2;
};

/// The polynomial on [0, 1] with these ends.
Coefficients hermite(const End& from, const End& to) noexcept {
    const double d = to.f - from.f - from.f1 - 0.5 * from.f2;
    const double d1 = to.f1 - from.f1 - from.f2;
    const double d2 = to.f2 - from.f2;
    return {from.f,
            from.f1,
            0.5 * from.f2,
            10.0 * d - 4.0 * d1 + 0.5 * d2,
            -15.0 * d + 7.0 * d1 - d2,
            6.0 * d - 3.0 * d1 + 0.5 * d2};
}

/// The contour, and the axes first..last-1 in which it is measured.
class Curve {
public:
    Curve(const PathElement& before, const PathElement& after, double reach) noexcept
        : first_{hasCartesianMotion(before) ? 0 : before.space.cartesian},
          last_{hasCartesianMotion(before) ? before.space.cartesian : before.space.axes} {
        PathDerivatives from;
        PathDerivatives to;
        planner::evaluate(before, before.length - reach, from);
        planner::evaluate(after, reach, to);
        // The first derivatives are those of the cubic with both inner points in the corner; the
        // second are its own plus what the curvatures of the elements ask for.
        const double speed = 3.0 * reach;
        for (std::size_t i = 0; i < before.space.axes; ++i) {
            const double corner = before.to[i].count();
            const double bend = 2.0 * speed;
            curve_[i] = hermite(
                {from.q[i] - corner, speed * from.d1[i],
                 speed * speed * from.d2[i] - bend * from.d1[i]},
                {to.q[i] - corner, speed * to.d1[i], speed * speed * to.d2[i] + bend * to.d1[i]});
        }
    }

    [[nodiscard]] const auto& coefficients() const noexcept { return curve_; }

    [[nodiscard]] double speed(double u) const noexcept {
        double sum = 0.0;
        for (std::size_t i = first_; i < last_; ++i) {
            const double d = taylor(curve_[i], u).f1;
            sum += d * d;
        }
        return std::sqrt(sum);
    }

    [[nodiscard]] double distance(double u) const noexcept {
        double sum = 0.0;
        for (std::size_t i = first_; i < last_; ++i) {
            const double d = taylor(curve_[i], u).f;
            sum += d * d;
        }
        return std::sqrt(sum);
    }

    /// u as a function of the length, and its derivatives.
    [[nodiscard]] End inverseAt(double u) const noexcept {
        double n2 = 0.0;
        double dot = 0.0;
        for (std::size_t i = first_; i < last_; ++i) {
            const Taylor t = taylor(curve_[i], u);
            n2 += t.f1 * t.f1;
            dot += t.f1 * t.f2;
        }
        return {u, 1.0 / std::sqrt(n2), -dot / (n2 * n2)};
    }

    /// Five points of Gauss and Legendre.
    [[nodiscard]] double lengthBetween(double from, double to) const noexcept {
        constexpr std::array<double, 3> kNode{0.0, 0.53846931010568309104, 0.90617984593866399280};
        constexpr std::array<double, 3> kWeight{0.56888888888888888889, 0.47862867049936646804,
                                                0.23692688505618908751};
        const double centre = 0.5 * (from + to);
        const double half = 0.5 * (to - from);
        double sum = kWeight[0] * speed(centre);
        for (std::size_t k = 1; k < kNode.size(); ++k) {
            const double d = half * kNode[k];
            sum += kWeight[k] * (speed(centre - d) + speed(centre + d));
        }
        return half * sum;
    }

    /// How far the direction moves.
    [[nodiscard]] double turnBetween(double from, double to) const noexcept {
        const double a = 1.0 / speed(from);
        const double b = 1.0 / speed(to);
        double sum = 0.0;
        for (std::size_t i = first_; i < last_; ++i) {
            const double d = taylor(curve_[i], to).f1 * b - taylor(curve_[i], from).f1 * a;
            sum += d * d;
        }
        return std::sqrt(sum);
    }

    [[nodiscard]] double closest() const noexcept;
    /// The farthest that it is beside both elements.
    [[nodiscard]] double stray(const PathElement& before, const PathElement& after) const noexcept;

private:
    [[nodiscard]] double beside(const PathElement& element, const PathPoint& corner,
                                double u) const noexcept;

    std::size_t first_;
    std::size_t last_;
    std::array<Coefficients, maxPathAxes> curve_{};
};

double Curve::closest() const noexcept {
    constexpr int kCoarse = 32;
    int best = 0;
    for (int k = 1; k <= kCoarse; ++k) {
        if (distance(k / static_cast<double>(kCoarse)) <
            distance(best / static_cast<double>(kCoarse)))
            best = k;
    }
    double low = std::max(0, best - 1) / static_cast<double>(kCoarse);
    double high = std::min(kCoarse, best + 1) / static_cast<double>(kCoarse);
    for (int k = 0; k < 40; ++k) {
        const double third = (high - low) / 3.0;
        if (distance(low + third) < distance(high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    return distance(0.5 * (low + high));
}

/// Distance of the point at u from the line, or from the circle of the arc.
double Curve::beside(const PathElement& element, const PathPoint& corner, double u) const noexcept {
    const bool line = element.kind == ElementKind::Line;
    std::array<double, maxPathAxes> away{};
    double along = 0.0;
    double across = 0.0;
    for (std::size_t i = first_; i < last_; ++i) {
        const double origin = line ? element.to[i].count() : element.centre[i];
        away[i] = corner[i].count() + taylor(curve_[i], u).f - origin;
        along += away[i] * (line ? element.slope[i] : element.u[i]);
        if (!line) across += away[i] * element.w[i];
    }
    double rest = 0.0;
    double rise = 0.0;
    for (std::size_t i = first_; i < last_; ++i) {
        const double d = line ? away[i] - along * element.slope[i]
                              : away[i] - along * element.u[i] - across * element.w[i];
        rest += d * d;
        if (!line) rise += element.slope[i] * element.slope[i];
    }
    if (line) return std::sqrt(rest);
    const double ring = std::sqrt(along * along + across * across) - element.radius;
    // A helix leaves the plane of its circle anyway.
    return std::sqrt(ring * ring + (rise > 0.0 ? 0.0 : rest));
}

double Curve::stray(const PathElement& before, const PathElement& after) const noexcept {
    constexpr int kSamples = 64;
    constexpr double kBetween = 1.001;  // it may be a little more between the samples
    double most = 0.0;
    for (int k = 1; k < kSamples; ++k) {
        const double u = k / static_cast<double>(kSamples);
        most = std::max(most, std::min(beside(before, before.to, u), beside(after, before.to, u)));
    }
    return most * kBetween;
}

constexpr std::size_t kMeasures = 128;

double stepOf(std::size_t k) noexcept {
    return static_cast<double>(k) / static_cast<double>(kMeasures);
}

/// A curve up to equal steps of u: its length, and a mixture of length and turning, either of which
/// is 1 at the end.
struct Measures {
    std::array<double, kMeasures + 1> length{};
    std::array<double, kMeasures + 1> mixture{};

    explicit Measures(const Curve& curve) noexcept {
        std::array<double, kMeasures + 1> turning{};
        for (std::size_t k = 0; k < kMeasures; ++k) {
            length[k + 1] = length[k] + curve.lengthBetween(stepOf(k), stepOf(k + 1));
            turning[k + 1] = turning[k] + curve.turnBetween(stepOf(k), stepOf(k + 1));
        }
        const double turn = std::max(turning.back(), 1e-3);
        for (std::size_t k = 0; k <= kMeasures; ++k)
            mixture[k] = length[k] / length.back() + turning[k] / turn;
    }

    /// The u at which a share of the mixture is reached, near enough.
    [[nodiscard]] double at(double share) const noexcept {
        const double sought = share * mixture.back();
        std::size_t k = 0;
        while (k + 1 < kMeasures && mixture[k + 1] <= sought) ++k;
        const double part = (sought - mixture[k]) / (mixture[k + 1] - mixture[k]);
        return stepOf(k) + part / static_cast<double>(kMeasures);
    }
};

bool isLinePair(const PathElement& before, const PathElement& after) noexcept {
    return before.kind == ElementKind::Line && after.kind == ElementKind::Line;
}

}  // namespace

PathBlend::PathBlend(const PathElement& before, const PathElement& after, double reach) noexcept
    : space_{before.space}, corner_{before.to}, reach_{reach} {
    const Curve curve{before, after, reach};
    curve_ = curve.coefficients();
    const Measures measures{curve};
    End from = curve.inverseAt(0.0);
    for (std::size_t k = 0; k < kSpans; ++k) {
        const bool last = k + 1 == kSpans;
        const double share = static_cast<double>(k + 1) / static_cast<double>(kSpans);
        const End to = curve.inverseAt(last ? 1.0 : measures.at(share));
        const double span = curve.lengthBetween(from.f, to.f);
        starts_[k + 1] = starts_[k] + span;
        parameter_[k] = hermite({from.f, from.f1 * span, from.f2 * span * span},
                                {to.f, to.f1 * span, to.f2 * span * span});
        from = to;
    }
    length_ = starts_.back();
}

void PathBlend::evaluate(double s, PathDerivatives& out) const noexcept {
    std::size_t k = 0;
    for (std::size_t step = kSpans / 2; step > 0; step /= 2) {
        if (starts_[k + step] <= s) k += step;
    }
    const double perSpan = 1.0 / (starts_[k + 1] - starts_[k]);
    const Taylor u = taylor(parameter_[k], std::clamp((s - starts_[k]) * perSpan, 0.0, 1.0));
    const double u1 = u.f1 * perSpan;
    const double u2 = u.f2 * perSpan * perSpan;
    const double u3 = u.f3 * perSpan * perSpan * perSpan;
    for (std::size_t i = 0; i < space_.axes; ++i) {
        const Taylor b = taylor(curve_[i], u.f);
        out.q[i] = corner_[i].count() + b.f;
        out.d1[i] = b.f1 * u1;
        out.d2[i] = b.f2 * u1 * u1 + b.f1 * u2;
        out.d3[i] = b.f3 * u1 * u1 * u1 + 3.0 * b.f2 * u1 * u2 + b.f1 * u3;
    }
}

double deviationOf(const PathElement& before, const PathElement& after, double reach) noexcept {
    const Curve curve{before, after, reach};
    return std::max(curve.closest(), curve.stray(before, after));
}

double reachForDeviation(const PathElement& before, const PathElement& after, double deviation,
                         double most) noexcept {
    if (isLinePair(before, after)) {
        // At u = 1/2 the cubic is c (q2' - q1') / 8 away from the corner.
        const bool cartesian = hasCartesianMotion(before);
        const std::size_t first = cartesian ? 0 : before.space.cartesian;
        const std::size_t last = cartesian ? before.space.cartesian : before.space.axes;
        double turn = 0.0;
        for (std::size_t i = first; i < last; ++i) {
            const double d = after.slope[i] - before.slope[i];
            turn += d * d;
        }
        const double reach = 8.0 * deviation / std::sqrt(turn);
        return reach < most ? reach : most;
    }
    if (deviationOf(before, after, most) <= deviation) return most;
    double low = 0.0;
    double high = most;
    for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (low + high);
        (deviationOf(before, after, middle) <= deviation ? low : high) = middle;
    }
    return low;
}

}  // namespace takt::planner
