#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <takt/record/plot_data.hpp>
#include <vector>

namespace takt::record {

/// A commanded value is drawn broad and pale, a measured one thin on top of it.
enum class CurveStyle : std::uint8_t { Commanded, Measured };

struct PlotCurve {
    std::string column;
    std::string label;      ///< in the legend
    std::size_t colour{0};  ///< curves of one axis share a number
    CurveStyle style{CurveStyle::Measured};
};

struct PlotPanel {
    std::string title;
    std::string unit;
    std::vector<PlotCurve> curves;
};

/// A Text column as a coloured band.
struct PlotBand {
    std::string column;
    std::string label;
    std::size_t colour{0};  ///< of the label; the same number as the curves of that axis
};

struct PlotSpec {
    std::string title;
    std::string subtitle;
    std::vector<PlotBand> bands;
    std::vector<PlotPanel> panels;
};

/// Every column that the plot shows, for PlotData.
[[nodiscard]] std::vector<std::string> columnsOf(const PlotSpec& spec);

/// The plot as an SVG document: the bands above, the panels below each other, one time axis. The
/// same data give the same text. Columns that `data` does not have are left out.
[[nodiscard]] std::string drawSvg(const PlotSpec& spec, const PlotData& data);

}  // namespace takt::record
