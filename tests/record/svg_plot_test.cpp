#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <takt/record/motion_trace.hpp>
#include <takt/record/svg_plot.hpp>

namespace takt::record {
namespace {

const std::vector<std::string> stateNames{"Disabled", "Standstill", "Homing", "DiscreteMotion"};

/// X goes to and fro on a smooth path while Y follows half a period later, and so on.
std::string drawn(int rows, std::string_view title = "gantry", int axisCount = 2) {
    std::vector<MotionAxis> axes{{"X", "mm"}, {"Y", "mm"}};
    for (int a = 2; a < axisCount; ++a) axes.push_back({"A" + std::to_string(a), "mm"});
    const PlotSpec spec = motionPlot(title, "3 axes on the twin, 1 ms", axes);
    TraceRecorder trace{motionColumns(axes, stateNames), 16};
    PlotData data{trace.columns(), "t_ns", columnsOf(spec)};
    TraceSink* sinks[] = {&data};
    for (int k = 0; k < rows; ++k) {
        TraceRow row = trace.row();
        putCycle(row, static_cast<core::CycleNumber>(k),
                 core::HostTime{std::chrono::milliseconds{k}});
        for (int a = 0; a < axisCount; ++a) {
            const double u = static_cast<double>((k + a * 400) % 1600) / 800.0 - 1.0;
            const double s = 1.0 - std::fabs(u);
            MotionSample sample;
            sample.state = k < 200 ? 0U : k < 300 ? 1U : 3U;
            sample.set = 100.0 * s * s * (3.0 - 2.0 * s);
            sample.setVelocity = (u < 0 ? 1.0 : -1.0) * 750.0 * s * (1.0 - s);
            sample.setAcceleration = 900.0 * (1.0 - 2.0 * s);
            sample.actual = sample.set - sample.setVelocity * 0.002;
            sample.actualVelocity = sample.setVelocity;
            sample.lag = sample.set - sample.actual;
            putAxis(row, sample);
        }
        row.commit();
        trace.drain(sinks);
    }
    return drawSvg(spec, data);
}

std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(SvgPlot, DrawsOneCurveForEachColumn) {
    const std::string svg = drawn(2000);
    EXPECT_EQ(occurrences(svg, "\" d=\"M"), 12U);  // position 4, velocity 4, acceleration 2, lag 2
    EXPECT_EQ(occurrences(svg, "DiscreteMotion</title>"), 2U);
    EXPECT_NE(svg.find("velocity  [mm/s]"), std::string::npos);
}

TEST(SvgPlot, NamesAsManyCurvesAsHaveRoomBesideTheirPanel) {
    const std::string svg = drawn(2000, "line", 16);
    // 32 curves of position and of velocity, 16 of acceleration and of lag; ten lines for each.
    EXPECT_EQ(occurrences(svg, "class=\"key\" text-anchor=\"start\">and 23 more<"), 2U);
    EXPECT_EQ(occurrences(svg, "class=\"key\" text-anchor=\"start\">and 7 more<"), 2U);
    EXPECT_EQ(occurrences(drawn(2000), " more<"), 0U);
}

TEST(SvgPlot, IsTheSameTextForTheSameData) {
    EXPECT_EQ(drawn(3000), drawn(3000));
}

TEST(SvgPlot, StaysSmallForALongTrace) {
    EXPECT_LT(drawn(200000).size(), 400000U);
}

TEST(SvgPlot, EscapesNamesForXml) {
    EXPECT_NE(drawn(10, "a<b & \"c\"").find("a&lt;b &amp; &quot;c&quot;"), std::string::npos);
}

TEST(SvgPlot, DrawsAnEmptyTrace) {
    const std::string svg = drawn(0);
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(SvgPlot, DrawsValuesBeyondEveryScale) {
    const std::vector<TraceColumn> columns{{"t_ns", ColumnKind::Integer, {}},
                                           {"v", ColumnKind::Real, {}}};
    const PlotSpec spec{"t", "", {}, {{"p", "mm", {{"v", "v", 0, CurveStyle::Measured}}}}};
    PlotData data{columns, "t_ns", columnsOf(spec)};
    constexpr double Max = std::numeric_limits<double>::max();
    for (const double v : {-Max, Max, std::numeric_limits<double>::infinity()}) {
        const TraceCell row[] = {TraceCell{.integer = 0}, TraceCell{.real = v}};
        data.take(row);
    }
    EXPECT_NE(drawSvg(spec, data).find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace takt::record
