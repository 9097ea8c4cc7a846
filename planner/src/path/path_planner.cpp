#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <takt/planner/path_planner.hpp>

#include "barrier.hpp"
#include "section.hpp"

namespace takt::planner {

namespace {

/// The limits are planned for with these shares until the differences keep them. A feed from rest
/// needs the first only: it can be made slower as a whole.
constexpr std::array<double, 5> kShares{0.998, 0.99, 0.97, 0.94, 0.9};

/// Of the limits of velocity: they are met exactly, and what is left lets the next plan begin.
constexpr double kSpeedShare = 0.9999;
/// A feed from rest that would have to become slower than this is planned again.
constexpr double kMostStretch = 1.5;
/// Slower feeds meet the cycles elsewhere, so it may take more than one round, with ever more
/// added.
constexpr int kMostRounds = 10;

/// What a difference may exceed its limit by: rounding.
constexpr double kRounding = 1e-9;

bool isPositive(double limit) noexcept {
    return limit > 0.0;
}

std::optional<PathError> check(const PathElement& element) noexcept {
    const PathFeed& f = element.feed;
    if (!isPositive(f.velocity.count()) || !isPositive(f.acceleration.count()) ||
        !isPositive(f.deceleration.count()) || !isPositive(f.jerk.count()))
        return PathError::InvalidLimits;
    const Transition& t = element.transition;
    const bool sized =
        t.mode == TransitionMode::CornerDistance || t.mode == TransitionMode::CornerDeviation;
    if ((sized && !(t.size.count() >= 0.0)) || !isPositive(t.velocity.count()))
        return PathError::InvalidTransition;
    return std::nullopt;
}

}  // namespace

void axesAt(const PathGeometry& geometry, const FeedState& feed,
            std::span<PathAxisState> out) noexcept {
    PathDerivatives at;
    geometry.evaluate(feed.s, at);
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = {core::Position{at.q[i]}, core::Velocity{at.d1[i] * feed.s1},
                  core::Acceleration{at.d1[i] * feed.s2 + at.d2[i] * feed.s1 * feed.s1}};
    }
}

struct PathPlanner::Work {
    PathSpace space;
    std::array<PathAxisLimits, maxPathAxes> axes{};
    core::Seconds cycle;
    std::size_t maxElements;
    Effort effort{};
    detail::Grid grid;
    detail::Rows rows;
    detail::BarrierSolver solver;

    [[nodiscard]] detail::LimitSet limits(double share) const noexcept {
        return {{axes.data(), space.axes}, cycle.count(), share, share < 1.0 ? kSpeedShare : 1.0};
    }
    [[nodiscard]] std::optional<PathError> check() const noexcept;
    std::optional<PathError> append(std::span<const PathElement> elements, double notBefore,
                                    PathGeometry& out);
    bool tryShare(const detail::Section& section, double share, PathMotion& out);
    std::optional<PathError> planSection(const detail::Section& section, PathMotion& out);
    std::optional<PathError> planSections(double from, PathMotion& out);
    core::Result<std::uint64_t, PathError> finish(std::optional<PathError> error, PathMotion& out);
};

std::optional<PathError> PathPlanner::Work::check() const noexcept {
    for (std::size_t i = 0; i < space.axes; ++i) {
        const double v = axes[i].velocity.count();
        const double a = axes[i].acceleration.count();
        const double j = axes[i].jerk.count();
        if (!std::isfinite(v + a + j)) return PathError::NotFinite;
        if (!isPositive(v) || !isPositive(a) || !isPositive(j)) return PathError::InvalidLimits;
    }
    if (!std::isfinite(cycle.count()) || !isPositive(cycle.count()))
        return PathError::InvalidLimits;
    return std::nullopt;
}

std::optional<PathError> PathPlanner::Work::append(std::span<const PathElement> elements,
                                                   double notBefore, PathGeometry& out) {
    for (const PathElement& element : elements) {
        if (const auto error = planner::check(element)) return error;
        const auto joint = out.append(element, notBefore);
        if (!joint.ok()) return joint.error();
    }
    return std::nullopt;
}

/// \return whether the section's feed was added, keeping all limits
bool PathPlanner::Work::tryShare(const detail::Section& section, double share, PathMotion& out) {
    const std::size_t first = out.feed.size();
    ++effort.attempts;
    if (!detail::addStraight(out.geometry, section, limits(kShares[0]), out.feed)) {
        const detail::LimitSet set = limits(share);
        if (!detail::makeGrid(out.geometry, section, set, grid)) return false;
        detail::makeRows(out.geometry, section, grid, set, rows);
        const bool solved = solver.solve(section, grid, rows);
        effort.cells += grid.cells();
        effort.newtonSteps += solver.steps();
        if (!solved) return false;
        detail::addPieces(section, grid, solver.coefficients(), out.feed);
    }
    out.feed.restAt(section.to);
    for (int round = 0; round < kMostRounds; ++round) {
        const double stretch = detail::stretchNeeded(out.geometry, out.feed, first, limits(1.0));
        if (stretch <= 1.0 + kRounding) return true;
        if (!section.fromRest || !(stretch < kMostStretch)) break;
        out.feed.stretch(first, stretch * (1.0 + kRounding * (1 << 2 * round)));
        out.feed.restAt(section.to);
    }
    out.feed.truncate(first);
    return false;
}

std::optional<PathError> PathPlanner::Work::planSection(const detail::Section& section,
                                                        PathMotion& out) {
    for (const double share : kShares) {
        if (tryShare(section, share, out)) return std::nullopt;
    }
    return PathError::NoFeed;
}

/// From rest at a place, section by section, to the end of the path.
std::optional<PathError> PathPlanner::Work::planSections(double from, PathMotion& out) {
    const PathGeometry& path = out.geometry;
    double begin = from;
    for (std::size_t i = 0; i < path.pieceCount(); ++i) {
        const PathPiece& piece = path.piece(i);
        const bool last = i + 1 == path.pieceCount();
        const double end = last ? path.length() : path.piece(i + 1).start;
        if ((piece.end != JointKind::Stop && !last) || end <= begin) continue;
        if (const auto error = planSection({begin, end, true, 0.0, 0.0}, out)) return error;
        begin = end;
    }
    out.feed.restAt(path.length());
    return std::nullopt;
}

core::Result<std::uint64_t, PathError> PathPlanner::Work::finish(std::optional<PathError> error,
                                                                 PathMotion& out) {
    if (error) return *error;
    return out.feed.cycles();
}

PathPlanner::PathPlanner(const PathSpace& space, std::span<const PathAxisLimits> limits,
                         core::Seconds cycle, std::size_t maxElements)
    : work_{std::make_unique<Work>()} {
    assert(limits.size() == space.axes && space.axes <= maxPathAxes);
    work_->space = space;
    work_->cycle = cycle;
    work_->maxElements = maxElements;
    std::copy(limits.begin(), limits.end(), work_->axes.begin());
}

PathPlanner::~PathPlanner() = default;
PathPlanner::PathPlanner(PathPlanner&&) noexcept = default;
PathPlanner& PathPlanner::operator=(PathPlanner&&) noexcept = default;

PathMotion PathPlanner::motion() const {
    return {work_->space, work_->maxElements, work_->cycle};
}

const PathPlanner::Effort& PathPlanner::effort() const noexcept {
    return work_->effort;
}

core::Result<std::uint64_t, PathError> PathPlanner::plan(std::span<const PathElement> elements,
                                                         PathMotion& out) {
    work_->effort = {};
    out.geometry.clear();
    out.feed.clear();
    auto error = work_->check();
    if (!error) error = work_->append(elements, 0.0, out.geometry);
    if (!error) error = work_->planSections(0.0, out);
    return work_->finish(error, out);
}

namespace {

/// The last stop before the end of a path, or its beginning.
double lastStop(const PathGeometry& path) noexcept {
    double stop = 0.0;
    for (std::size_t i = 0; i + 1 < path.pieceCount(); ++i) {
        if (path.piece(i).end == JointKind::Stop) stop = path.piece(i + 1).start;
    }
    return stop;
}

/// The first stop behind a place.
double nextStop(const PathGeometry& path, double s) noexcept {
    for (std::size_t i = path.pieceAt(s); i + 1 < path.pieceCount(); ++i) {
        if (path.piece(i).end == JointKind::Stop) return path.piece(i + 1).start;
    }
    return path.length();
}

}  // namespace

core::Result<std::uint64_t, PathError> PathPlanner::extend(const PathMotion& running,
                                                           std::uint64_t from,
                                                           std::span<const PathElement> more,
                                                           PathMotion& out,
                                                           std::optional<Transition> joint) {
    work_->effort = {};
    if (const auto error = work_->check()) return *error;
    const FeedState state = running.feed.at(from);
    const double time = static_cast<double>(from) * running.feed.cycle();
    const double oldEnd = running.geometry.length();
    const bool atRest = state.s1 == 0.0 && state.s2 == 0.0;

    out.geometry = running.geometry;
    if (joint) out.geometry.setEndTransition(*joint);
    // What is left already makes room first.
    const double shift = out.geometry.dropBefore(state.s);
    const std::size_t oldPieces = out.geometry.pieceCount();
    const double stop = std::max(lastStop(running.geometry), 0.0);
    if (const auto error = work_->append(more, state.s - shift, out.geometry)) return *error;
    const bool through =
        !more.empty() && oldPieces > 0 && nextStop(out.geometry, oldEnd - shift) >= 0.0 &&
        out.geometry.piece(std::min(oldPieces, out.geometry.pieceCount()) - 1).end !=
            JointKind::Stop;

    out.feed.clear();
    if (through && state.s < stop) {
        // The section whose end has changed lies ahead: it begins at rest.
        out.feed.addRest(running.feed, time, stop, shift);
        return work_->finish(work_->planSections(stop - shift, out), out);
    }
    if (through && !atRest) {
        const detail::Section section{state.s - shift, nextStop(out.geometry, state.s - shift),
                                      false, state.s1 * state.s1, 2.0 * state.s2};
        if (!work_->planSection(section, out))
            return work_->finish(work_->planSections(section.to, out), out);
        // No feed from this state: the joint stays the stop that it was planned as.
        out.geometry = running.geometry;
        out.geometry.dropBefore(state.s);
        out.geometry.stopAtEnd();
        if (const auto error = work_->append(more, state.s - shift, out.geometry)) return *error;
        out.feed.clear();
    } else if (through) {
        return work_->finish(work_->planSections(state.s - shift, out), out);
    }
    out.feed.addRest(running.feed, time, oldEnd, shift);
    return work_->finish(work_->planSections(oldEnd - shift, out), out);
}

}  // namespace takt::planner
