#include "svg_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace takt::record::svg {

namespace {

std::string fixed(double value, int decimals) {
    std::array<char, 400> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                      std::chars_format::fixed, decimals);
    return {buffer.data(), result.ptr};
}

/// Square of the distance of `p` from the line through `a` and `b`.
double distanceSquared(Point p, Point a, Point b) {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double length = dx * dx + dy * dy;
    if (length == 0.0) return (p.x - a.x) * (p.x - a.x) + (p.y - a.y) * (p.y - a.y);
    const double cross = dx * (p.y - a.y) - dy * (p.x - a.x);
    return cross * cross / length;
}

}  // namespace

std::string pixel(double value) {
    const double rounded = std::round(value * 10.0);
    if (rounded == 0.0) return "0";
    const bool whole = std::fmod(rounded, 10.0) == 0.0;
    return fixed(rounded / 10.0, whole ? 0 : 1);
}

void appendPixel(std::string& text, double value) {
    text += pixel(value);
}

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::vector<Point> simplified(const std::vector<Point>& points, double tolerance) {
    if (points.size() < 3) return points;
    std::vector<bool> keep(points.size(), false);
    keep.front() = keep.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        double worst = tolerance * tolerance;
        std::size_t split = 0;
        for (std::size_t i = first + 1; i < last; ++i) {
            const double d = distanceSquared(points[i], points[first], points[last]);
            if (d > worst) {
                worst = d;
                split = i;
            }
        }
        if (split == 0) continue;
        keep[split] = true;
        open.emplace_back(first, split);
        open.emplace_back(split, last);
    }
    std::vector<Point> kept;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (keep[i]) kept.push_back(points[i]);
    }
    return kept;
}

std::string Ticks::label(int index) const {
    const std::string text = fixed(at(index), decimals);
    return text.find_first_not_of("-0.") == std::string::npos ? fixed(0.0, decimals) : text;
}

Ticks niceTicks(double low, double high, int wanted) {
    const double raw = (high - low) / wanted;
    if (!std::isfinite(raw)) return {};  // a range beyond what a double can tell
    double power = 1.0;
    int decimals = 0;
    while (power > raw) {
        power /= 10.0;
        ++decimals;
    }
    while (power * 10.0 <= raw) power *= 10.0;
    if (power >= 1.0) decimals = 0;
    Ticks ticks;
    ticks.step = power * 10.0;
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (power * factor >= raw) {
            ticks.step = power * factor;
            break;
        }
    }
    if (ticks.step >= power * 10.0 && decimals > 0) --decimals;
    ticks.decimals = decimals;
    const double firstIndex = std::ceil(low / ticks.step - 1e-9);
    const double lastIndex = std::floor(high / ticks.step + 1e-9);
    ticks.first = firstIndex * ticks.step;
    ticks.count = static_cast<int>(lastIndex - firstIndex) + 1;
    return ticks;
}

}  // namespace takt::record::svg
