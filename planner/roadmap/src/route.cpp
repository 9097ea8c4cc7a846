#include <algorithm>
#include <cmath>
#include <optional>
#include <takt/core/random.hpp>
#include <takt/planner/roadmap/route.hpp>

#include "corners.hpp"
#include "shorten.hpp"
#include "tree_search.hpp"

namespace takt::planner::roadmap {

namespace {

struct Refusal {
    RouteFault fault;
    std::size_t which{0};
};

bool isGood(const RouteRequest& request, const Obstacles& obstacles) noexcept {
    const std::size_t axes = request.axes.size();
    if (axes < 1 || axes > Obstacles::MaxAxes || request.start.size() != axes ||
        request.goal.size() != axes || obstacles.axisBound() > axes || request.pathAxes < 1)
        return false;
    const double rounding = request.rounding.count();
    if (!(rounding >= 0.0) || !std::isfinite(rounding)) return false;
    for (std::size_t i = 0; i < axes; ++i) {
        const RouteAxis& axis = request.axes[i];
        const bool finite = std::isfinite(axis.low.count()) && std::isfinite(axis.high.count()) &&
                            std::isfinite(axis.velocity.count()) &&
                            std::isfinite(request.start[i]) && std::isfinite(request.goal[i]);
        if (!finite || !(axis.low < axis.high) || !(axis.velocity.count() > 0.0)) return false;
    }
    return true;
}

std::optional<std::size_t> firstOutside(Point point, std::span<const RouteAxis> axes) noexcept {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (point[i] < axes[i].low.count() || point[i] > axes[i].high.count()) return i;
    }
    return std::nullopt;
}

std::optional<Refusal> refusalOf(const RouteRequest& request, const Obstacles& obstacles) {
    if (!isGood(request, obstacles)) return Refusal{RouteFault::BadRequest};
    if (const auto axis = firstOutside(request.start, request.axes))
        return Refusal{RouteFault::StartOutsideLimits, *axis};
    if (const auto axis = firstOutside(request.goal, request.axes))
        return Refusal{RouteFault::GoalOutsideLimits, *axis};
    if (const auto keepOut = obstacles.around(request.start))
        return Refusal{RouteFault::StartInKeepOut, *keepOut};
    if (const auto keepOut = obstacles.around(request.goal))
        return Refusal{RouteFault::GoalInKeepOut, *keepOut};
    return std::nullopt;
}

/// Time at full speed; axes that no keep-out concerns follow in proportion and do not count.
Metric searchMetric(const RouteRequest& request, const Obstacles& obstacles) {
    std::vector<double> factors;
    for (std::size_t i = 0; i < request.axes.size(); ++i)
        factors.push_back(obstacles.concern(i) ? 1.0 / request.axes[i].velocity.count() : 0.0);
    return Metric{std::move(factors)};
}

/// The shortest of several searches, each shortened; empty when the first finds none.
Polyline search(const SearchProblem& problem, const RouteRequest& request,
                std::uint32_t& iterations) {
    constexpr double NearEnough = 1.0 + 1e-3;  // to the straight line, which nothing beats
    constexpr double Ranges[] = {0.25, 0.1, 0.5};
    // A further search that needs much longer than the first finds nothing that is shorter.
    constexpr std::uint32_t Patience = 4;
    constexpr std::uint32_t LeastPatience = 200;
    const Metric& metric = problem.metric;
    const double extent = metric.distance(problem.low, problem.high);
    const double least = metric.distance(problem.start, problem.goal);
    core::Random seeds{request.seed};
    Polyline best;
    SearchTry attempt;
    std::uint32_t share = request.effort.iterations;
    for (std::uint32_t i = 0; i < request.effort.attempts; ++i) {
        attempt.seed = seeds.next();
        attempt.range = Ranges[i % std::size(Ranges)] * extent;
        attempt.iterations = std::min(share, request.effort.iterations - iterations);
        SearchResult found = searchTree(problem, attempt);
        iterations += found.iterations;
        if (i == 0) share = std::max(Patience * found.iterations, LeastPatience);
        if (found.line.empty()) {
            if (best.empty()) break;
            continue;
        }
        shorten(found.line, problem.obstacles, metric, seeds, request.effort.shortcuts);
        const double length = metric.length(found.line);
        if (length >= attempt.knownLength) continue;
        attempt.knownLength = length;
        best = std::move(found.line);
        if (length <= least * NearEnough) break;
    }
    constexpr double Detour = 1.02;  // that fewer corners are worth
    mergeCorners(best, problem.obstacles, metric, problem.low, problem.high,
                 metric.length(best) * Detour);
    return best;
}

/// Gives the axes that no keep-out concerns their share of the way.
void spreadOthers(Polyline& line, const RouteRequest& request, const Metric& metric) {
    const double whole = metric.length(line);
    double passed = 0.0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (i > 0) passed += metric.distance(line[i - 1], line[i]);
        const double share = i + 1 == line.size() ? 1.0 : whole > 0.0 ? passed / whole : 0.0;
        for (std::size_t axis = 0; axis < metric.axes(); ++axis) {
            if (metric.factor(axis) > 0.0) continue;
            const double from = request.start[axis];
            line[i][axis] = from + share * (request.goal[axis] - from);
        }
    }
}

}  // namespace

RouteAnswer planRoute(const RouteRequest& request, const Obstacles& obstacles) {
    RouteAnswer answer;
    if (const auto refusal = refusalOf(request, obstacles)) {
        answer.fault = refusal->fault;
        answer.which = refusal->which;
        return answer;
    }
    const Metric metric = searchMetric(request, obstacles);
    Polyline line{{request.start.begin(), request.start.end()},
                  {request.goal.begin(), request.goal.end()}};
    if (!obstacles.isFree(request.start, request.goal)) {
        std::vector<double> low;
        std::vector<double> high;
        std::vector<double> goal;
        for (std::size_t i = 0; i < metric.axes(); ++i) {
            low.push_back(request.axes[i].low.count());
            high.push_back(request.axes[i].high.count());
            goal.push_back(metric.factor(i) > 0.0 ? request.goal[i] : request.start[i]);
        }
        line =
            search({obstacles, metric, low, high, request.start, goal}, request, answer.iterations);
        if (line.empty()) {
            answer.fault = RouteFault::NoRoute;
            return answer;
        }
        spreadOthers(line, request, metric);
        line.back().assign(request.goal.begin(), request.goal.end());
    }
    answer.points = roundCorners(std::move(line), obstacles, request);
    std::vector<double> factors;
    for (const RouteAxis& axis : request.axes) factors.push_back(1.0 / axis.velocity.count());
    const Metric all{std::move(factors)};
    for (std::size_t i = 1; i < answer.points.size(); ++i) {
        answer.length +=
            core::Seconds{all.distance(answer.points[i - 1].position, answer.points[i].position)};
    }
    return answer;
}

}  // namespace takt::planner::roadmap
