#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <takt/record/trace.hpp>
#include <vector>

namespace takt::record {

/// An axis of the drawing: where it runs and what bounds it.
struct TopViewAxis {
    std::string name;
    std::string unit;
    double low{0.0};
    double high{1.0};  ///< above low
};

/// Something to be kept clear of, seen from above: a rectangle, whose sides may be infinite, or a
/// circle. What it takes with its clearance is drawn around it.
struct TopViewShape {
    struct Circle {
        double x{0.0};
        double y{0.0};
        double radius{0.0};
    };
    std::string label;
    double left{0.0};
    double right{0.0};
    double bottom{0.0};
    double top{0.0};
    std::optional<Circle> circle;  ///< in place of the rectangle
    double clearance{0.0};
};

struct TopViewSpec {
    std::string title;
    std::string subtitle;
    TopViewAxis x;
    TopViewAxis y;
    std::vector<TopViewShape> shapes;
};

/// Keeps the way of two axes in the plane while a trace is recorded: the set positions, without
/// what happens while an axis is Disabled or Homing. Memory is bounded: a long way is thinned out
/// where that changes it least.
class TopViewData : public TraceSink {
public:
    struct Place {
        double x;
        double y;
    };

    /// The columns X.set, X.state, Y.set and Y.state are looked at.
    /// \param tolerance the way may be drawn as much beside the real one, in units of the axes
    TopViewData(const std::vector<TraceColumn>& columns, std::string_view x, std::string_view y,
                double tolerance);

    void take(std::span<const TraceCell> row) override;

    /// The stretches of the way, each without a gap.
    [[nodiscard]] const std::vector<std::vector<Place>>& ways() const noexcept { return ways_; }

private:
    struct Axis {
        std::size_t set{0};
        std::size_t state{0};
        std::vector<bool> rests;  ///< for each state: the axis is not to be drawn
    };
    [[nodiscard]] static Axis axisOf(const std::vector<TraceColumn>& columns,
                                     std::string_view name);
    void thin();

    Axis x_;
    Axis y_;
    double tolerance_;
    bool open_{false};  ///< the last stretch goes on
    std::size_t places_{0};
    std::vector<std::vector<Place>> ways_;
};

/// The plane of two axes with keep-outs and way as an SVG document, to scale. The same data give
/// the same text.
[[nodiscard]] std::string drawTopView(const TopViewSpec& spec, const TopViewData& data);

}  // namespace takt::record
