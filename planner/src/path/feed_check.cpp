#include <algorithm>
#include <cmath>
#include <limits>
#include <takt/core/trigonometry.hpp>

#include "section.hpp"

namespace takt::planner::detail {

namespace {

/// Of a piece of feed that lasts longer, so many differences are looked at, evenly spread.
constexpr std::int64_t kMostPerPiece = 64;
/// What the greatest may be missed by then, where the path bends.
constexpr double kMissed = 1e-4;

/// Four positions in consecutive cycles.
struct Window {
    std::array<PathDerivatives, 4> at{};
    std::array<double, 4> s{};
    std::array<PathFeed, 4> feed{};
};

class Judge {
public:
    Judge(const PathGeometry& geometry, const FeedProfile& feed, const LimitSet& limits)
        : geometry_{geometry}, feed_{feed}, limits_{limits} {}

    /// Cycles first..first+3.
    void look(std::int64_t first, double margin) {
        const std::int64_t keep = filled_ ? std::clamp<std::int64_t>(4 - (first - at_), 0, 4) : 0;
        const auto kept = static_cast<std::size_t>(keep);
        for (std::size_t i = 0; i < kept; ++i) {
            window_.at[i] = window_.at[i + 4 - kept];
            window_.s[i] = window_.s[i + 4 - kept];
            window_.feed[i] = window_.feed[i + 4 - kept];
        }
        for (std::size_t i = kept; i < 4; ++i) sample(i, first + static_cast<std::int64_t>(i));
        at_ = first;
        filled_ = true;
        margin_ = margin;
        compare();
    }

    [[nodiscard]] double stretch() const noexcept { return stretch_; }

private:
    void sample(std::size_t i, std::int64_t cycle) {
        window_.s[i] = feed_.atTime(static_cast<double>(cycle) * feed_.cycle()).s;
        const std::size_t piece = geometry_.pieceAt(window_.s[i]);
        geometry_.evaluate(piece, window_.s[i], window_.at[i]);
        window_.feed[i] = geometry_.feedOf(piece);
    }

    void compare() {
        for (std::size_t i = 0; i < limits_.axes.size(); ++i) {
            const auto& w = window_.at;
            const PathAxisLimits& axis = limits_.axes[i];
            take({w[0].q[i], w[1].q[i], w[2].q[i], w[3].q[i]}, axis.velocity.count(),
                 axis.acceleration.count(), axis.acceleration.count(), axis.jerk.count());
        }
        PathFeed most = window_.feed[0];
        for (const PathFeed& f : window_.feed) {
            most.velocity = std::max(most.velocity, f.velocity);
            most.acceleration = std::max(most.acceleration, f.acceleration);
            most.deceleration = std::max(most.deceleration, f.deceleration);
            most.jerk = std::max(most.jerk, f.jerk);
        }
        take(window_.s, most.velocity.count(), most.acceleration.count(), most.deceleration.count(),
             most.jerk.count());
    }

    void take(const std::array<double, 4>& q, double v, double up, double down, double j) {
        const double h = limits_.cycle;
        const double size = std::max(std::fabs(q[0]), std::fabs(window_.s[0]));
        const double noise = 4.0 * std::numeric_limits<double>::epsilon() * size;
        const double q1 = std::fabs(q[1] - q[0]) - noise;
        const double q2 = q[2] - 2.0 * q[1] + q[0];
        const double q3 = std::fabs(q[3] - 3.0 * (q[2] - q[1]) - q[0]) - 8.0 * noise;
        const double a = (std::fabs(q2) - 4.0 * noise) / (h * h * (q2 > 0.0 ? up : down));
        double most = q1 / (h * v);
        if (a > 0.0) most = std::max(most, std::sqrt(a));
        const double jerk = q3 / (h * h * h * j);
        if (jerk > 0.0) most = std::max(most, core::cubeRoot(jerk));
        stretch_ = std::max(stretch_, most * margin_);
    }

    const PathGeometry& geometry_;
    const FeedProfile& feed_;
    const LimitSet& limits_;
    Window window_{};
    std::int64_t at_{0};
    bool filled_{false};
    double margin_{1.0};
    double stretch_{0.0};
};

}  // namespace

double stretchNeeded(const PathGeometry& geometry, const FeedProfile& feed, std::size_t firstPiece,
                     const LimitSet& limits) {
    Judge judge{geometry, feed, limits};
    const double h = feed.cycle();
    for (std::size_t i = firstPiece; i < feed.size(); ++i) {
        const double end = feed[i].start + feed[i].duration;
        // Windows that begin in this piece, and for a start at rest those that reach into it.
        auto first = static_cast<std::int64_t>(std::ceil(feed[i].start / h));
        if (i == firstPiece && feed[i].from.s1 == 0.0) first -= 3;
        // What was before a feed that begins in motion is not known here.
        if (feed[0].from.s1 != 0.0) first = std::max<std::int64_t>(first, 0);
        const auto last = static_cast<std::int64_t>(end / h);
        const std::int64_t step = std::max<std::int64_t>(1, (last - first) / kMostPerPiece);
        const bool exact = step == 1 || feed[i].constantJerk;
        for (std::int64_t k = first; k <= last; k += step)
            judge.look(k, exact ? 1.0 : 1.0 + kMissed);
    }
    return judge.stretch();
}

}  // namespace takt::planner::detail
