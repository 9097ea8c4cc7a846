#include <algorithm>
#include <cmath>
#include <takt/record/top_view.hpp>

#include "svg_text.hpp"

namespace takt::record {

namespace {

using svg::escaped;
using svg::pixel;

constexpr std::size_t MaxPlaces = 8192;
constexpr double Left = 84.0;
constexpr double Top = 64.0;
constexpr double Bottom = 56.0;
constexpr double Margin = 24.0;
constexpr double LongestSide = 860.0;

constexpr const char* Style =
    "<style>text{font-family:'DejaVu Sans',Verdana,Arial,sans-serif;fill:#333}"
    ".title{font-size:20px;font-weight:bold}.sub{font-size:13px;fill:#666}"
    ".head{font-size:13px;font-weight:bold}.tick{font-size:12px;fill:#555}"
    ".key{font-size:12px}.grid{stroke:#e6e6e6;stroke-width:1}"
    ".frame{fill:none;stroke:#999;stroke-width:1}.near{fill:#F6D8AE;fill-opacity:.5}"
    ".keepout{fill:#D55E00;fill-opacity:.55;stroke:#A34700;stroke-width:1}"
    ".way{fill:none;stroke:#0072B2;stroke-width:2;stroke-linejoin:round}"
    ".end{fill:#0072B2}</style>\n";

/// Draws one document, x to the right and y upwards, to scale.
class Drawing {
public:
    Drawing(const TopViewSpec& spec, const TopViewData& data)
        : spec_{spec},
          data_{data},
          scale_{LongestSide / std::max(spec.x.high - spec.x.low, spec.y.high - spec.y.low)},
          width_{(spec.x.high - spec.x.low) * scale_},
          height_{(spec.y.high - spec.y.low) * scale_} {}

    std::string draw();

private:
    [[nodiscard]] double px(double x) const { return Left + (x - spec_.x.low) * scale_; }
    [[nodiscard]] double py(double y) const { return Top + (spec_.y.high - y) * scale_; }
    void text(double x, double y, std::string_view cssClass, std::string_view anchor,
              std::string_view content);
    void line(double x1, double y1, double x2, double y2);
    void grid();
    void shape(const TopViewShape& shape, double grown, std::string_view cssClass);
    void label(const TopViewShape& shape);
    void way(const std::vector<TopViewData::Place>& places);
    void dot(const TopViewData::Place& place);

    const TopViewSpec& spec_;
    const TopViewData& data_;
    double scale_;
    double width_;
    double height_;
    std::string out_;
};

void Drawing::text(double x, double y, std::string_view cssClass, std::string_view anchor,
                   std::string_view content) {
    out_ += "<text x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" class=\"";
    out_ += cssClass;
    out_ += "\" text-anchor=\"";
    out_ += anchor;
    out_ += "\">" + escaped(content) + "</text>\n";
}

void Drawing::line(double x1, double y1, double x2, double y2) {
    out_ += "<line x1=\"" + pixel(x1) + "\" y1=\"" + pixel(y1) + "\" x2=\"" + pixel(x2) +
            "\" y2=\"" + pixel(y2) + "\" class=\"grid\"/>\n";
}

void Drawing::grid() {
    const svg::Ticks across = svg::niceTicks(spec_.x.low, spec_.x.high, 8);
    for (int i = 0; i < across.count; ++i) {
        const double x = px(across.at(i));
        line(x, Top, x, Top + height_);
        text(x, Top + height_ + 18.0, "tick", "middle", across.label(i));
    }
    const svg::Ticks up = svg::niceTicks(spec_.y.low, spec_.y.high, 6);
    for (int i = 0; i < up.count; ++i) {
        const double y = py(up.at(i));
        line(Left, y, Left + width_, y);
        text(Left - 8.0, y + 4.0, "tick", "end", up.label(i));
    }
    text(Left + width_ / 2.0, Top + height_ + 40.0, "head", "middle",
         spec_.x.name + "  [" + spec_.x.unit + "]");
    text(Left - 8.0, Top - 8.0, "head", "end", spec_.y.name + "  [" + spec_.y.unit + "]");
}

/// Only what lies in the drawing is drawn of it: the frame clips the rest.
void Drawing::shape(const TopViewShape& shape, double grown, std::string_view cssClass) {
    if (shape.circle) {
        out_ += "<circle cx=\"" + pixel(px(shape.circle->x)) + "\" cy=\"" +
                pixel(py(shape.circle->y)) + "\" r=\"" +
                pixel((shape.circle->radius + grown) * scale_);
    } else {
        const double left = px(std::max(shape.left - grown, spec_.x.low));
        const double right = px(std::min(shape.right + grown, spec_.x.high));
        const double top = py(std::min(shape.top + grown, spec_.y.high));
        const double bottom = py(std::max(shape.bottom - grown, spec_.y.low));
        out_ += "<rect x=\"" + pixel(left) + "\" y=\"" + pixel(top) + "\" width=\"" +
                pixel(std::max(right - left, 0.0)) + "\" height=\"" +
                pixel(std::max(bottom - top, 0.0));
    }
    out_ += "\" class=\"";
    out_ += cssClass;
    out_ += "\"/>\n";
}

void Drawing::label(const TopViewShape& shape) {
    const double x =
        shape.circle
            ? shape.circle->x
            : 0.5 * (std::max(shape.left, spec_.x.low) + std::min(shape.right, spec_.x.high));
    const double y =
        shape.circle
            ? shape.circle->y
            : 0.5 * (std::max(shape.bottom, spec_.y.low) + std::min(shape.top, spec_.y.high));
    text(px(x), py(y) + 4.0, "key", "middle", shape.label);
}

void Drawing::way(const std::vector<TopViewData::Place>& places) {
    std::vector<svg::Point> points;
    points.reserve(places.size());
    for (const TopViewData::Place& place : places) points.push_back({px(place.x), py(place.y)});
    std::string path;
    char command = 'M';
    for (const svg::Point& point : svg::simplified(points, 0.1)) {
        path += command;
        svg::appendPixel(path, point.x);
        path += ' ';
        svg::appendPixel(path, point.y);
        command = 'L';
    }
    if (points.size() > 1) out_ += "<path class=\"way\" d=\"" + path + "\"/>\n";
}

void Drawing::dot(const TopViewData::Place& place) {
    out_ += "<circle cx=\"" + pixel(px(place.x)) + "\" cy=\"" + pixel(py(place.y)) +
            "\" r=\"4\" class=\"end\"/>\n";
}

std::string Drawing::draw() {
    text(Left, 30.0, "title", "start", spec_.title);
    if (!spec_.subtitle.empty()) text(Left, 50.0, "sub", "start", spec_.subtitle);
    const std::string frame = "x=\"" + pixel(Left) + "\" y=\"" + pixel(Top) + "\" width=\"" +
                              pixel(width_) + "\" height=\"" + pixel(height_) + '"';
    out_ += "<clipPath id=\"frame\"><rect " + frame + "/></clipPath>\n<rect " + frame +
            " fill=\"#fff\"/>\n";
    grid();
    out_ += "<g clip-path=\"url(#frame)\">\n";
    for (const TopViewShape& one : spec_.shapes) shape(one, one.clearance, "near");
    for (const TopViewShape& one : spec_.shapes) shape(one, 0.0, "keepout");
    for (const auto& places : data_.ways()) way(places);
    for (const auto& places : data_.ways()) {
        if (places.size() < 2) continue;  // it only stood there
        dot(places.front());
        dot(places.back());
    }
    for (const TopViewShape& one : spec_.shapes) label(one);
    out_ += "</g>\n<rect " + frame + " class=\"frame\"/>\n";
    const double wide = Left + width_ + Margin;
    const double high = Top + height_ + Bottom;
    const std::string size = "width=\"" + pixel(wide) + "\" height=\"" + pixel(high) + '"';
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg "
           "xmlns=\"http://www.w3.org/2000/svg\" " +
           size + " viewBox=\"0 0 " + pixel(wide) + ' ' + pixel(high) + "\">\n" + Style + "<rect " +
           size + " fill=\"#fcfcfc\"/>\n" + out_ + "</svg>\n";
}

}  // namespace

TopViewData::TopViewData(const std::vector<TraceColumn>& columns, std::string_view x,
                         std::string_view y, double tolerance)
    : x_{axisOf(columns, x)}, y_{axisOf(columns, y)}, tolerance_{tolerance} {}

TopViewData::Axis TopViewData::axisOf(const std::vector<TraceColumn>& columns,
                                      std::string_view name) {
    Axis axis;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].name == std::string{name} + ".set") axis.set = i;
        if (columns[i].name != std::string{name} + ".state") continue;
        axis.state = i;
        for (const std::string& state : columns[i].names)
            axis.rests.push_back(state == "Disabled" || state == "Homing");
    }
    return axis;
}

void TopViewData::take(std::span<const TraceCell> row) {
    const auto rests = [&row](const Axis& axis) {
        const auto state = static_cast<std::size_t>(row[axis.state].integer);
        return state >= axis.rests.size() || axis.rests[state];
    };
    if (rests(x_) || rests(y_)) {
        open_ = false;
        return;
    }
    const Place place{row[x_.set].real, row[y_.set].real};
    if (!open_) {
        ways_.emplace_back();
        open_ = true;
    }
    std::vector<Place>& way = ways_.back();
    if (!way.empty() && way.back().x == place.x && way.back().y == place.y) return;
    way.push_back(place);
    if (++places_ > MaxPlaces) thin();
}

void TopViewData::thin() {
    // Half is kept free, or it would be thinned out again at once.
    constexpr std::size_t Enough = MaxPlaces / 2;
    constexpr int Doublings = 30;
    for (int i = 0; i < Doublings; ++i) {
        places_ = 0;
        for (std::vector<Place>& way : ways_) {
            std::vector<svg::Point> points;
            points.reserve(way.size());
            for (const Place& place : way) points.push_back({place.x, place.y});
            way.clear();
            for (const svg::Point& point : svg::simplified(points, tolerance_))
                way.push_back({point.x, point.y});
            places_ += way.size();
        }
        if (places_ <= Enough) return;
        tolerance_ *= 2.0;
    }
    // Thousands of stretches: the older ones go.
    ways_.erase(ways_.begin(), ways_.begin() + static_cast<std::ptrdiff_t>(ways_.size() / 2));
}

std::string drawTopView(const TopViewSpec& spec, const TopViewData& data) {
    return Drawing{spec, data}.draw();
}

}  // namespace takt::record
