#include <algorithm>
#include <array>
#include <cmath>
#include <takt/record/svg_plot.hpp>
#include <utility>

#include "svg_text.hpp"

namespace takt::record {

namespace {

using svg::escaped;
using svg::pixel;
using svg::Point;

constexpr double Width = 1200.0;
constexpr double Left = 84.0;
constexpr double Right = 1080.0;  // the legend is to the right of it
constexpr double Top = 64.0;
constexpr double BandHeight = 20.0;
constexpr double BandGap = 4.0;
constexpr double PanelHeight = 168.0;
constexpr double PanelGap = 34.0;
constexpr double Bottom = 48.0;
constexpr double CharacterWidth = 6.4;  // of the 11 px text inside the bands

// Colours that stay apart for colour-blind readers (Okabe and Ito).
constexpr std::array<const char*, 7> CurveColours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                  "#E69F00", "#56B4E9", "#4D4D4D"};
constexpr std::array<const char*, 6> OtherStateColours{"#C7C7E2", "#F6D8AE", "#BFE3D0",
                                                       "#F3C6D3", "#D9E3A8", "#CFCFCF"};
constexpr std::array<std::pair<const char*, const char*>, 8> StateColours{
    {{"Disabled", "#D9D9D9"},
     {"Standstill", "#C6DBEF"},
     {"Homing", "#FDD9A0"},
     {"DiscreteMotion", "#A1D99B"},
     {"ContinuousMotion", "#66C2A4"},
     {"SynchronizedMotion", "#BCBDDC"},
     {"Stopping", "#FDAE6B"},
     {"ErrorStop", "#E34A33"}}};

const char* curveColour(std::size_t index) {
    return CurveColours[index % CurveColours.size()];
}

const char* stateColour(std::string_view name, std::size_t value) {
    const auto* known = std::find_if(StateColours.begin(), StateColours.end(),
                                     [&](const auto& entry) { return name == entry.first; });
    return known != StateColours.end() ? known->second
                                       : OtherStateColours[value % OtherStateColours.size()];
}

constexpr const char* Style =
    "<style>text{font-family:'DejaVu Sans',Verdana,Arial,sans-serif;fill:#333}"
    ".title{font-size:20px;font-weight:bold}.sub{font-size:13px;fill:#666}"
    ".head{font-size:13px;font-weight:bold}.tick{font-size:12px;fill:#555}"
    ".key{font-size:12px}.state{font-size:11px;fill:#333}"
    ".grid{stroke:#e6e6e6;stroke-width:1}.zero{stroke:#b0b0b0;stroke-width:1}"
    ".frame{fill:none;stroke:#999;stroke-width:1}"
    ".set{fill:none;stroke-width:4;stroke-opacity:.32;stroke-linejoin:round}"
    ".act{fill:none;stroke-width:1.4;stroke-linejoin:round}</style>\n";

struct Range {
    double low{0.0};
    double high{0.0};
    bool valid{false};

    void add(double a, double b) {
        low = valid ? std::min(low, a) : a;
        high = valid ? std::max(high, b) : b;
        valid = true;
    }
};

/// Draws one document; the parts are called from top to bottom.
class Painter {
public:
    Painter(const PlotSpec& spec, const PlotData& data)
        : spec_{spec},
          data_{data},
          begin_{data.beginTime()},
          end_{data.endTime() > data.beginTime() ? data.endTime() : data.beginTime() + 1.0},
          timeTicks_{svg::niceTicks(begin_, end_, 10)} {}

    std::string draw();

private:
    [[nodiscard]] double x(double time) const {
        return Left + (time - begin_) / (end_ - begin_) * (Right - Left);
    }
    void text(double px, double py, std::string_view cssClass, std::string_view anchor,
              std::string_view content, std::string_view extra = {});
    void line(double x1, double y1, double x2, double y2, std::string_view cssClass);
    void rectangle(double px, double py, double width, double height, std::string_view attributes,
                   std::string_view hint = {});
    void band(const PlotBand& band);
    void bandKey();
    void panel(const PlotPanel& panel);
    void panelGrid(const Range& range);
    void panelLegend(const PlotPanel& panel);
    void curve(const PlotCurve& curve, const Range& range);
    void timeAxis();
    [[nodiscard]] Range rangeOf(const PlotPanel& panel) const;

    const PlotSpec& spec_;
    const PlotData& data_;
    double begin_;
    double end_;
    svg::Ticks timeTicks_;
    double y_{Top};
    std::string out_;
};

void Painter::text(double px, double py, std::string_view cssClass, std::string_view anchor,
                   std::string_view content, std::string_view extra) {
    out_ += "<text x=\"" + pixel(px) + "\" y=\"" + pixel(py) + "\" class=\"";
    out_ += cssClass;
    out_ += "\" text-anchor=\"";
    out_ += anchor;
    out_ += '"';
    out_ += extra;
    out_ += '>' + escaped(content) + "</text>\n";
}

void Painter::line(double x1, double y1, double x2, double y2, std::string_view cssClass) {
    out_ += "<line x1=\"" + pixel(x1) + "\" y1=\"" + pixel(y1) + "\" x2=\"" + pixel(x2) +
            "\" y2=\"" + pixel(y2) + "\" class=\"";
    out_ += cssClass;
    out_ += "\"/>\n";
}

void Painter::rectangle(double px, double py, double width, double height,
                        std::string_view attributes, std::string_view hint) {
    out_ += "<rect x=\"" + pixel(px) + "\" y=\"" + pixel(py) + "\" width=\"" + pixel(width) +
            "\" height=\"" + pixel(height) + "\" ";
    out_ += attributes;
    if (hint.empty()) {
        out_ += "/>\n";
    } else {
        out_ += "><title>" + escaped(hint) + "</title></rect>\n";
    }
}

void Painter::band(const PlotBand& band) {
    const auto runs = data_.runs(band.column);
    const auto names = data_.names(band.column);
    text(Left - 10.0, y_ + 15.0, "head", "end", band.label,
         std::string{" style=\"fill:"} + curveColour(band.colour) + '"');
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const double from = x(runs[i].begin);
        const double to = i + 1 < runs.size() ? x(runs[i + 1].begin) : Right;
        const std::string name =
            runs[i].value < names.size() ? names[runs[i].value] : std::to_string(runs[i].value);
        rectangle(from, y_, std::max(to - from, 0.3), BandHeight,
                  std::string{"fill=\""} + stateColour(name, runs[i].value) + '"', name);
        if (to - from > CharacterWidth * static_cast<double>(name.size()) + 8.0) {
            text((from + to) / 2.0, y_ + 14.0, "state", "middle", name);
        }
    }
    rectangle(Left, y_, Right - Left, BandHeight, "class=\"frame\"");
    y_ += BandHeight + BandGap;
}

/// The states that occur, with their colours: most stretches are too short to carry their name.
void Painter::bandKey() {
    std::vector<std::pair<std::string, const char*>> seen;
    for (const PlotBand& band : spec_.bands) {
        const auto names = data_.names(band.column);
        for (const PlotRun& run : data_.runs(band.column)) {
            const std::string name =
                run.value < names.size() ? names[run.value] : std::to_string(run.value);
            const auto same = [&](const auto& entry) { return entry.first == name; };
            if (std::none_of(seen.begin(), seen.end(), same)) {
                seen.emplace_back(name, stateColour(name, run.value));
            }
        }
    }
    double px = Left;
    for (const auto& [name, colour] : seen) {
        const double width = 34.0 + 7.4 * static_cast<double>(name.size());
        if (px + width > Right && px > Left) {
            px = Left;
            y_ += 20.0;
        }
        rectangle(px, y_ + 4.0, 14.0, 12.0,
                  std::string{"fill=\""} + colour + "\" stroke=\"#999\" stroke-width=\".5\"");
        text(px + 19.0, y_ + 14.0, "key", "start", name);
        px += width;
    }
    y_ += 16.0 + PanelGap;
}

Range Painter::rangeOf(const PlotPanel& panel) const {
    Range range;
    for (const PlotCurve& curve : panel.curves) {
        for (const PlotBin& bin : data_.curve(curve.column)) {
            if (bin.valid) range.add(bin.low, bin.high);
        }
    }
    if (!range.valid) range.add(0.0, 1.0);
    double margin = (range.high - range.low) * 0.06;
    if (!(margin > 0.0)) margin = range.high == 0.0 ? 0.5 : std::fabs(range.high) * 0.5;
    range.low -= margin;
    range.high += margin;
    return range;
}

void Painter::panelGrid(const Range& range) {
    for (int i = 0; i < timeTicks_.count; ++i) {
        const double px = x(timeTicks_.at(i));
        line(px, y_, px, y_ + PanelHeight, "grid");
    }
    const svg::Ticks ticks = svg::niceTicks(range.low, range.high, 5);
    for (int i = 0; i < ticks.count; ++i) {
        const double value = ticks.at(i);
        const double py = y_ + PanelHeight * (range.high - value) / (range.high - range.low);
        const bool zero = std::fabs(value) < 0.5 * ticks.step;
        line(Left, py, Right, py, zero ? "zero" : "grid");
        text(Left - 8.0, py + 4.0, "tick", "end", ticks.label(i));
    }
}

void Painter::panelLegend(const PlotPanel& panel) {
    constexpr double lineHeight = 17.0;
    constexpr auto mostLines = static_cast<std::size_t>(PanelHeight / lineHeight) + 1;
    const auto shown = static_cast<std::size_t>(std::count_if(
        panel.curves.begin(), panel.curves.end(),
        [this](const PlotCurve& curve) { return !data_.curve(curve.column).empty(); }));
    double py = y_ + 14.0;
    std::size_t lines = 0;
    for (const PlotCurve& curve : panel.curves) {
        if (data_.curve(curve.column).empty()) continue;
        if (++lines == mostLines && shown > mostLines) {
            // The next panel's legend begins below.
            text(Right + 40.0, py, "key", "start",
                 "and " + std::to_string(shown - mostLines + 1) + " more");
            return;
        }
        const bool commanded = curve.style == CurveStyle::Commanded;
        out_ += "<path d=\"M" + pixel(Right + 12.0) + ' ' + pixel(py - 4.0) + "h22\" class=\"";
        out_ += commanded ? "set" : "act";
        out_ += std::string{"\" stroke=\""} + curveColour(curve.colour) + "\"/>\n";
        text(Right + 40.0, py, "key", "start", curve.label);
        py += lineHeight;
    }
}

void Painter::curve(const PlotCurve& curve, const Range& range) {
    const auto bins = data_.curve(curve.column);
    const auto y = [&](double value) {
        return y_ + PanelHeight * (range.high - value) / (range.high - range.low);
    };
    std::string path;
    std::vector<Point> points;
    const auto endPiece = [&] {
        char command = 'M';
        for (const Point& point : svg::simplified(points, 0.12)) {
            path += command;
            svg::appendPixel(path, point.x);
            path += ' ';
            svg::appendPixel(path, point.y);
            command = 'L';
        }
        points.clear();
    };
    for (const PlotBin& bin : bins) {
        if (!bin.valid) {
            endPiece();  // a gap where the trace has no finite number
            continue;
        }
        const Point low{x(bin.lowTime), y(bin.low)};
        const Point high{x(bin.highTime), y(bin.high)};
        const bool lowFirst = bin.lowTime <= bin.highTime;
        points.push_back(lowFirst ? low : high);
        if (bin.low != bin.high) points.push_back(lowFirst ? high : low);
    }
    endPiece();
    if (path.empty()) return;
    out_ += std::string{"<path class=\""} + (curve.style == CurveStyle::Commanded ? "set" : "act") +
            "\" stroke=\"" + curveColour(curve.colour) + "\" d=\"" + path + "\"/>\n";
}

void Painter::panel(const PlotPanel& panel) {
    const Range range = rangeOf(panel);
    text(Left, y_ - 8.0, "head", "start", panel.title + "  [" + panel.unit + "]");
    rectangle(Left, y_, Right - Left, PanelHeight, "fill=\"#fff\"");
    panelGrid(range);
    for (const PlotCurve& one : panel.curves) curve(one, range);
    rectangle(Left, y_, Right - Left, PanelHeight, "class=\"frame\"");
    panelLegend(panel);
    y_ += PanelHeight + PanelGap;
}

void Painter::timeAxis() {
    const double base = y_ - PanelGap;
    for (int i = 0; i < timeTicks_.count; ++i) {
        const double px = x(timeTicks_.at(i));
        line(px, base, px, base + 5.0, "zero");
        text(px, base + 20.0, "tick", "middle", timeTicks_.label(i));
    }
    text((Left + Right) / 2.0, base + 40.0, "head", "middle", "time  [s]");
    y_ = base + Bottom;
}

std::string Painter::draw() {
    text(Left, 30.0, "title", "start", spec_.title);
    if (!spec_.subtitle.empty()) text(Left, 50.0, "sub", "start", spec_.subtitle);
    for (const PlotBand& one : spec_.bands) {
        if (!data_.runs(one.column).empty()) band(one);
    }
    bandKey();
    for (const PlotPanel& one : spec_.panels) panel(one);
    timeAxis();
    const std::string size = "width=\"" + pixel(Width) + "\" height=\"" + pixel(y_) + '"';
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg "
           "xmlns=\"http://www.w3.org/2000/svg\" " +
           size + " viewBox=\"0 0 " + pixel(Width) + ' ' + pixel(y_) + "\">\n" + Style + "<rect " +
           size + " fill=\"#fcfcfc\"/>\n" + out_ + "</svg>\n";
}

}  // namespace

std::vector<std::string> columnsOf(const PlotSpec& spec) {
    std::vector<std::string> columns;
    for (const PlotBand& band : spec.bands) columns.push_back(band.column);
    for (const PlotPanel& panel : spec.panels) {
        for (const PlotCurve& curve : panel.curves) columns.push_back(curve.column);
    }
    return columns;
}

std::string drawSvg(const PlotSpec& spec, const PlotData& data) {
    return Painter{spec, data}.draw();
}

}  // namespace takt::record
