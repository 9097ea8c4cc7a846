#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <takt/planner/roadmap/roadmap_params.hpp>
#include <vector>

namespace takt::planner::roadmap {

/// Positions of all axes that are planned, in their user units.
using Point = std::span<const double>;

/// Keep-outs grown by their clearance, and exact tests against them. What only touches the surface
/// of a grown keep-out is free.
///
/// \pre every point has a position for each axis that a keep-out names
class Obstacles {
public:
    /// Most axes that can be planned.
    static constexpr std::size_t MaxAxes = 16;

    Obstacles() = default;
    explicit Obstacles(std::span<const KeepOutParams> keepOuts);

    [[nodiscard]] std::size_t size() const noexcept { return regions_.size(); }
    /// The keep-outs restrict this axis.
    [[nodiscard]] bool concern(std::size_t axis) const noexcept {
        return axis < MaxAxes && concerned_[axis];
    }
    /// All axes that keep-outs name lie below this number.
    [[nodiscard]] std::size_t axisBound() const noexcept { return axisBound_; }

    /// The first keep-out that the point lies in.
    [[nodiscard]] std::optional<std::size_t> around(Point point) const noexcept;
    /// Nothing on the straight line between two points lies in a keep-out.
    [[nodiscard]] bool isFree(Point from, Point to) const noexcept;
    /// Nothing of the triangle of three points lies in a keep-out.
    [[nodiscard]] bool isFree(Point a, Point b, Point c) const noexcept;

private:
    struct Slab {
        std::size_t axis;
        double low;
        double high;
    };
    struct Disc {
        std::size_t firstAxis;
        std::size_t secondAxis;
        double firstCentre;
        double secondCentre;
        double radius;
    };
    struct Region {
        std::vector<Slab> slabs;
        std::optional<Disc> disc;
    };

    [[nodiscard]] static bool contains(const Region& region, Point point) noexcept;
    [[nodiscard]] static bool crosses(const Region& region, Point from, Point to) noexcept;
    [[nodiscard]] static bool crosses(const Region& region, Point a, Point b, Point c) noexcept;

    std::vector<Region> regions_;
    bool concerned_[MaxAxes]{};
    std::size_t axisBound_{0};
};

}  // namespace takt::planner::roadmap
