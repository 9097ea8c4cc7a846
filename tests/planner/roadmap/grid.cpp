#include "grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace takt::planner::roadmap::test {

namespace {

using Values = std::vector<double>;

class Grid {
public:
    Grid(const Scene& scene, double cell) : scene_{scene}, cell_{cell}, axes_{scene.axes.size()} {
        std::size_t nodes = 1;
        for (const RouteAxis& axis : scene.axes) {
            counts_.push_back(
                static_cast<std::size_t>((axis.high - axis.low).count() / cell + 0.5) + 1);
            nodes *= counts_.back();
        }
        free_.assign(nodes, false);
        for (std::size_t node = 0; node < nodes; ++node) free_[node] = isFree(pointOf(node));
        makeSteps();
    }

    std::optional<double> solve() {
        const std::size_t from = nearest(scene_.start);
        const std::size_t to = nearest(scene_.goal);
        if (!free_[from] || !free_[to]) return std::nullopt;
        std::vector<std::size_t> parents(free_.size(), free_.size());
        std::vector<double> costs(free_.size(), std::numeric_limits<double>::infinity());
        using Entry = std::pair<double, std::size_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
        const Values goal = pointOf(to);
        costs[from] = 0.0;
        open.push({distance(pointOf(from), goal), from});
        std::vector<bool> closed(free_.size(), false);
        while (!open.empty()) {
            const std::size_t node = open.top().second;
            open.pop();
            if (closed[node]) continue;
            closed[node] = true;
            if (node == to) return pulled(parents, from, to);
            const Values here = pointOf(node);
            for (const std::vector<int>& step : steps_) {
                const std::size_t next = neighbour(node, step);
                if (next == free_.size() || closed[next] || !free_[next]) continue;
                const Values there = pointOf(next);
                const double cost = costs[node] + distance(here, there);
                if (cost >= costs[next] || !isFree(here, there)) continue;
                costs[next] = cost;
                parents[next] = node;
                open.push({cost + distance(there, goal), next});
            }
        }
        return std::nullopt;
    }

private:
    void makeSteps() {
        std::size_t all = 1;
        for (std::size_t i = 0; i < axes_; ++i) all *= 3;
        for (std::size_t code = 0; code < all; ++code) {
            std::vector<int> step;
            std::size_t rest = code;
            for (std::size_t i = 0; i < axes_; ++i, rest /= 3)
                step.push_back(static_cast<int>(rest % 3) - 1);
            if (std::any_of(step.begin(), step.end(), [](int s) { return s != 0; }))
                steps_.push_back(step);
        }
    }

    [[nodiscard]] Values pointOf(std::size_t node) const {
        Values point;
        for (std::size_t i = 0; i < axes_; ++i) {
            point.push_back(scene_.axes[i].low.count() +
                            cell_ * static_cast<double>(node % counts_[i]));
            node /= counts_[i];
        }
        return point;
    }

    [[nodiscard]] std::size_t nearest(const Values& point) const {
        std::size_t node = 0;
        for (std::size_t i = axes_; i-- > 0;) {
            const double place = (point[i] - scene_.axes[i].low.count()) / cell_;
            node = node * counts_[i] + static_cast<std::size_t>(std::lround(place));
        }
        return node;
    }

    [[nodiscard]] std::size_t neighbour(std::size_t node, const std::vector<int>& step) const {
        std::size_t rest = node;
        std::size_t stride = 1;
        std::size_t result = 0;
        for (std::size_t i = 0; i < axes_; ++i) {
            const auto place = static_cast<std::ptrdiff_t>(rest % counts_[i]) + step[i];
            if (place < 0 || place >= static_cast<std::ptrdiff_t>(counts_[i])) return free_.size();
            result += static_cast<std::size_t>(place) * stride;
            stride *= counts_[i];
            rest /= counts_[i];
        }
        return result;
    }

    [[nodiscard]] double distance(const Values& a, const Values& b) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < axes_; ++i) {
            const double time = (a[i] - b[i]) / scene_.axes[i].velocity.count();
            sum += time * time;
        }
        return std::sqrt(sum);
    }

    [[nodiscard]] bool isFree(const Values& point) const { return depth(scene_, point) <= 0.0; }
    [[nodiscard]] bool isFree(const Values& a, const Values& b) const {
        double longest = 0.0;
        for (std::size_t i = 0; i < axes_; ++i) longest = std::max(longest, std::abs(a[i] - b[i]));
        const int samples = std::max(1, static_cast<int>(longest / 2.0));
        Values point(axes_);
        for (int k = 1; k < samples; ++k) {
            const double share = static_cast<double>(k) / samples;
            for (std::size_t i = 0; i < axes_; ++i) point[i] = a[i] + share * (b[i] - a[i]);
            if (!isFree(point)) return false;
        }
        return true;
    }

    /// The way over the parents, each point joined with the last one in sight; the real ends count.
    [[nodiscard]] double pulled(const std::vector<std::size_t>& parents, std::size_t from,
                                std::size_t to) const {
        std::vector<Values> line{scene_.goal};
        for (std::size_t node = to; node != from; node = parents[node])
            line.push_back(pointOf(node));
        line.push_back(pointOf(from));
        line.push_back(scene_.start);
        double length = 0.0;
        for (std::size_t i = 0; i + 1 < line.size();) {
            std::size_t next = line.size() - 1;
            while (next > i + 1 && !isFree(line[i], line[next])) --next;
            length += distance(line[i], line[next]);
            i = next;
        }
        return length;
    }

    const Scene& scene_;
    double cell_;
    std::size_t axes_;
    std::vector<std::size_t> counts_;
    std::vector<bool> free_;
    std::vector<std::vector<int>> steps_;
};

}  // namespace

std::optional<double> gridLength(const Scene& scene, double cell) {
    return Grid{scene, cell}.solve();
}

}  // namespace takt::planner::roadmap::test
