#include "path_cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace takt::planner::test {

PathPoint point(std::initializer_list<double> coordinates) {
    PathPoint out{};
    std::size_t i = 0;
    for (const double c : coordinates) out[i++] = core::Position{c};
    return out;
}

PathElement lineTo(const PathSpace& space, std::initializer_list<double> from,
                   std::initializer_list<double> to) {
    return line(space, point(from), point(to)).value();
}

PathAxisLimits axisLimits(double v, double a, double j) {
    return {core::Velocity{v}, core::Acceleration{a}, core::Jerk{j}};
}

namespace {

Transition randomTransition(Random& random) {
    Transition t;
    switch (random.integer(0, 4)) {
        case 0:
            t.mode = TransitionMode::Stop;
            break;
        case 1:
            t.mode = TransitionMode::Exact;
            break;
        case 2:
            t.mode = TransitionMode::CornerDistance;
            t.size = core::Distance{random.logarithmic(0.01, 20.0)};
            break;
        default:
            t.mode = TransitionMode::CornerDeviation;
            t.size = core::Distance{random.logarithmic(0.001, 3.0)};
    }
    if (random.chance(0.2)) t.velocity = core::Velocity{random.logarithmic(2.0, 300.0)};
    return t;
}

PathFeed randomFeed(Random& random) {
    PathFeed feed;
    feed.velocity = core::Velocity{random.logarithmic(5.0, 500.0)};
    if (random.chance(0.3)) {
        feed.acceleration = core::Acceleration{random.logarithmic(200.0, 5000.0)};
        feed.deceleration = core::Acceleration{random.logarithmic(200.0, 5000.0)};
    }
    if (random.chance(0.3)) feed.jerk = core::Jerk{random.logarithmic(5000.0, 200000.0)};
    return feed;
}

PathElementResult randomElement(Random& random, const PathSpace& space, const PathPoint& from) {
    const double size = random.logarithmic(0.1, 100.0);
    PathPoint to = from;
    const auto away = [&] { return random.uniform(-size, size); };
    const bool cartesian = space.cartesian == 0 || random.chance(0.95);
    for (std::size_t i = cartesian ? 0 : space.cartesian; i < space.axes; ++i) {
        if (i < space.cartesian || random.chance(0.5)) to[i] = from[i] + core::Distance{away()};
    }
    if (space.cartesian < 2 || random.chance(0.6)) return line(space, from, to);
    PathPoint through = from;
    for (std::size_t i = 0; i < space.cartesian; ++i) through[i] = from[i] + core::Distance{away()};
    return arcByBorder(space, from, through, to);
}

}  // namespace

std::vector<PathElement> randomChain(Random& random, const PathSpace& space, PathPoint from,
                                     int elements) {
    std::vector<PathElement> out;
    while (static_cast<int>(out.size()) < elements) {
        const auto made = randomElement(random, space, from);
        if (!made.ok()) continue;
        PathElement element = made.value();
        element.feed = randomFeed(random);
        element.transition = randomTransition(random);
        element.tag = static_cast<std::uint32_t>(out.size());
        from = element.to;
        out.push_back(element);
    }
    return out;
}

PathCase randomPath(Random& random, int elements) {
    PathCase c;
    c.space.axes = static_cast<std::size_t>(random.integer(2, 5));
    c.space.cartesian = std::min(c.space.axes, static_cast<std::size_t>(random.integer(1, 3)));
    for (std::size_t i = 0; i < c.space.axes; ++i) {
        const double v = random.logarithmic(20.0, 500.0);
        const double a = v * random.logarithmic(3.0, 40.0);
        c.limits.push_back(axisLimits(v, a, a * random.logarithmic(8.0, 100.0)));
    }
    c.cycle = random.chance(0.5) ? 0.001 : random.chance(0.5) ? 0.002 : 0.00025;
    PathPoint from{};
    for (std::size_t i = 0; i < c.space.axes; ++i)
        from[i] = core::Position{random.uniform(-100.0, 100.0)};
    c.elements = randomChain(random, c.space, from, elements);
    return c;
}

std::vector<PathElement> squareLaps(const PathSpace& space, double side, int laps,
                                    const Transition& transition, double velocity) {
    const std::array<std::array<double, 2>, 5> corners{
        {{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}, {0.0, 0.0}}};
    std::vector<PathElement> out;
    for (int i = 0; i < 4 * laps; ++i) {
        const auto& a = corners[static_cast<std::size_t>(i) % 4];
        const auto& b = corners[static_cast<std::size_t>(i) % 4 + 1];
        PathElement e = lineTo(space, {a[0], a[1]}, {b[0], b[1]});
        e.feed.velocity = core::Velocity{velocity};
        e.transition = transition;
        out.push_back(e);
    }
    return out;
}

void Trace::add(const PathGeometry& geometry, double at, double shift) {
    PathDerivatives d;
    geometry.evaluate(at, d);
    axes = geometry.space().axes;
    rows.emplace_back(d.q.begin(), d.q.begin() + static_cast<std::ptrdiff_t>(axes));
    s.push_back(at + shift);
}

Trace traceOf(const PathMotion& motion) {
    Trace trace;
    for (int k = 0; k < 4; ++k) trace.add(motion.geometry, motion.feed.at(0).s);
    for (std::uint64_t k = 0; k <= motion.feed.cycles() + 4; ++k)
        trace.add(motion.geometry, motion.feed.at(k).s);
    return trace;
}

double Use::most() const {
    return std::max({velocity, acceleration, jerk});
}

Use useOf(const Trace& trace, std::span<const PathAxisLimits> limits, double cycle) {
    Use use;
    const long double h = cycle;
    const auto raise = [](double& most, long double value) {
        if (!(value <= most)) most = static_cast<double>(value);
    };
    for (std::size_t k = 0; k + 3 < trace.rows.size(); ++k) {
        if (!(trace.s[k + 1] >= trace.s[k] - 1e-12)) use.monotone = false;
        for (std::size_t i = 0; i < trace.axes; ++i) {
            const auto at = [&](std::size_t n) {
                return static_cast<long double>(trace.rows[k + n][i]);
            };
            // Positions and places are doubles: a difference knows no better than this.
            const long double noise =
                std::numeric_limits<double>::epsilon() *
                    (std::fabs(at(0)) + std::fabs(static_cast<long double>(trace.s[k]))) +
                1e-15L;
            const auto size = [&](long double x, int terms) {
                return std::max(0.0L, std::fabs(x) - static_cast<long double>(terms) * noise);
            };
            raise(use.velocity, size(at(1) - at(0), 4) / (h * limits[i].velocity.count()));
            raise(use.acceleration,
                  size(at(2) - 2 * at(1) + at(0), 16) / (h * h * limits[i].acceleration.count()));
            raise(use.jerk, size(at(3) - 3 * at(2) + 3 * at(1) - at(0), 32) /
                                (h * h * h * limits[i].jerk.count()));
        }
    }
    return use;
}

namespace {

/// Bounds of u = s2 at a point for x = s1^2, or an empty interval.
struct Bounds {
    double low;
    double high;
};

Bounds boundsAt(const PathDerivatives& at, std::span<const PathAxisLimits> limits,
                const PathFeed& feed, double x) {
    Bounds b{-feed.deceleration.count(), feed.acceleration.count()};
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const double a = limits[i].acceleration.count();
        const double offset = at.d2[i] * x;
        const double slope = at.d1[i];
        if (std::fabs(slope) < 1e-12) {
            if (std::fabs(offset) > a) return {1.0, -1.0};
            continue;
        }
        const double p = (-a - offset) / slope;
        const double q = (a - offset) / slope;
        b.low = std::max(b.low, std::min(p, q));
        b.high = std::min(b.high, std::max(p, q));
    }
    return b;
}

}  // namespace

double secondOrderTime(const PathGeometry& geometry, std::span<const PathAxisLimits> limits) {
    std::vector<double> s;
    std::vector<double> x;
    std::vector<PathDerivatives> at;
    std::vector<PathFeed> feed;
    for (std::size_t i = 0; i < geometry.pieceCount(); ++i) {
        const PathPiece& piece = geometry.piece(i);
        const int parts = 400;
        for (int k = 0; k <= parts; ++k) {
            s.push_back(piece.start + piece.length * k / parts);
            at.emplace_back();
            geometry.evaluate(i, s.back(), at.back());
            feed.push_back(geometry.feedOf(i));
            double most = feed.back().velocity.count();
            for (std::size_t a = 0; a < limits.size(); ++a) {
                const double d = std::fabs(at.back().d1[a]);
                if (d > 1e-12) most = std::min(most, limits[a].velocity.count() / d);
            }
            most *= most;
            // The greatest x that leaves any acceleration along the path, by halving.
            double low = 0.0;
            double high = most;
            for (int n = 0; n < 60; ++n) {
                const double middle = n == 0 ? most : 0.5 * (low + high);
                const Bounds b = boundsAt(at.back(), limits, feed.back(), middle);
                (b.low <= b.high ? low : high) = middle;
                if (n == 0 && b.low <= b.high) break;
            }
            const bool end = k == parts;
            double joint = end ? piece.endVelocity : unlimited;
            if (end && piece.end == JointKind::Stop) joint = 0.0;
            x.push_back(std::min(low, joint * joint));
            if (k == 0 && x.size() > 1) {
                const double both = std::min(x[x.size() - 2], x.back());
                x[x.size() - 2] = x.back() = both;
            }
        }
    }
    x.front() = 0.0;
    x.back() = 0.0;
    for (std::size_t i = x.size() - 1; i-- > 0;) {
        const Bounds b = boundsAt(at[i], limits, feed[i], std::min(x[i], x[i + 1]));
        x[i] = std::min(x[i], x[i + 1] - 2.0 * std::min(b.low, 0.0) * (s[i + 1] - s[i]));
    }
    for (std::size_t i = 1; i < x.size(); ++i) {
        const Bounds b = boundsAt(at[i], limits, feed[i], std::min(x[i], x[i - 1]));
        x[i] = std::min(x[i], x[i - 1] + 2.0 * std::max(b.high, 0.0) * (s[i] - s[i - 1]));
    }
    double time = 0.0;
    for (std::size_t i = 1; i < x.size(); ++i) {
        if (s[i] > s[i - 1])
            time += 2.0 * (s[i] - s[i - 1]) / (std::sqrt(x[i]) + std::sqrt(x[i - 1]));
    }
    return time;
}

}  // namespace takt::planner::test
