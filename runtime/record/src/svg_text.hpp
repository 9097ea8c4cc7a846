#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The small pieces an SVG plot is made of.
namespace takt::record::svg {

struct Point {
    double x;
    double y;
};

/// A coordinate in pixels with at most one decimal, without trailing zeros and without "-0".
void appendPixel(std::string& text, double value);
[[nodiscard]] std::string pixel(double value);

/// `text` with &, <, > and quotes written so that XML takes them.
[[nodiscard]] std::string escaped(std::string_view text);

/// Leaves out the points that lie within `tolerance` pixels of the line through their neighbours
/// (Douglas and Peucker), ends excepted.
[[nodiscard]] std::vector<Point> simplified(const std::vector<Point>& points, double tolerance);

/// Ticks at round numbers (1, 2 or 5 times a power of ten).
struct Ticks {
    double first{0.0};
    double step{1.0};
    int count{0};
    int decimals{0};  ///< that tell two ticks apart

    [[nodiscard]] double at(int index) const { return first + step * index; }
    [[nodiscard]] std::string label(int index) const;
};

/// Ticks inside low … high, about `wanted` of them. \pre low < high, both finite
[[nodiscard]] Ticks niceTicks(double low, double high, int wanted);

}  // namespace takt::record::svg
