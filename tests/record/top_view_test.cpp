#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <takt/record/top_view.hpp>

namespace takt::record {
namespace {

constexpr double Infinite = std::numeric_limits<double>::infinity();
enum State : std::int64_t { Disabled, Standstill, Homing, SynchronizedMotion };

const std::vector<TraceColumn> columns{
    {"X.state", ColumnKind::Text, {"Disabled", "Standstill", "Homing", "SynchronizedMotion"}},
    {"X.set", ColumnKind::Real, {}},
    {"Y.state", ColumnKind::Text, {"Disabled", "Standstill", "Homing", "SynchronizedMotion"}},
    {"Y.set", ColumnKind::Real, {}}};

void put(TopViewData& data, State state, double x, double y) {
    const TraceCell row[] = {TraceCell{.integer = state}, TraceCell{.real = x},
                             TraceCell{.integer = state}, TraceCell{.real = y}};
    data.take(row);
}

TopViewSpec spec() {
    TopViewSpec spec;
    spec.title = "a <machine>";
    spec.x = {"X", "mm", 0.0, 400.0};
    spec.y = {"Y", "mm", 0.0, 200.0};
    return spec;
}

TEST(TopView, KeepsTheWayWithoutWhatHomingDoes) {
    TopViewData data{columns, "X", "Y", 0.01};
    put(data, Disabled, 5.0, 5.0);
    put(data, Homing, 50.0, 5.0);
    put(data, Standstill, 0.0, 0.0);
    put(data, SynchronizedMotion, 10.0, 0.0);
    put(data, Disabled, 10.0, 0.0);
    put(data, Standstill, 20.0, 0.0);
    ASSERT_EQ(data.ways().size(), 2U);
    ASSERT_EQ(data.ways()[0].size(), 2U);
    EXPECT_EQ(data.ways()[0][0].x, 0.0);
    EXPECT_EQ(data.ways()[0][1].x, 10.0);
    ASSERT_EQ(data.ways()[1].size(), 1U);
}

TEST(TopView, StaysSmallAndNearTheWayForALongTrace) {
    TopViewData data{columns, "X", "Y", 0.04};
    constexpr int Rows = 300000;
    for (int i = 0; i < Rows; ++i) {
        const double angle = 1e-3 * i;
        put(data, SynchronizedMotion, 200.0 + 90.0 * std::cos(angle),
            100.0 + 90.0 * std::sin(angle));
    }
    std::size_t places = 0;
    for (const auto& way : data.ways()) {
        places += way.size();
        for (const auto& place : way)
            EXPECT_NEAR(std::hypot(place.x - 200.0, place.y - 100.0), 90.0, 1e-9);
        // Between two places the circle is left by no more than the tolerance, doubled a few times.
        for (std::size_t i = 1; i < way.size(); ++i) {
            const double x = 0.5 * (way[i].x + way[i - 1].x) - 200.0;
            const double y = 0.5 * (way[i].y + way[i - 1].y) - 100.0;
            ASSERT_GT(std::hypot(x, y), 90.0 - 0.5);
        }
    }
    EXPECT_LT(places, 10000U);
    EXPECT_LT(drawTopView(spec(), data).size(), 300000U);
}

TEST(TopView, StaysSmallWhereTheWayIsTornIntoManyPieces) {
    TopViewData data{columns, "X", "Y", 0.01};
    for (int i = 0; i < 100000; ++i) {
        put(data, Standstill, i % 400, 10.0);
        put(data, Homing, 0.0, 0.0);
    }
    EXPECT_LT(data.ways().size(), 10000U);
}

TEST(TopView, DrawsEveryKeepOutToScale) {
    TopViewSpec plan = spec();
    plan.shapes.push_back({"fixture", 100.0, 200.0, 50.0, 150.0, {}, 10.0});
    plan.shapes.push_back({"wall", 300.0, 310.0, -Infinite, Infinite, {}, 0.0});
    plan.shapes.push_back(
        {"post", 0.0, 0.0, 0.0, 0.0, TopViewShape::Circle{350.0, 100.0, 20.0}, 5.0});
    const TopViewData data{columns, "X", "Y", 0.01};
    const std::string svg = drawTopView(plan, data);
    // 860 pixels for 400 mm, from 84 on; y upwards from 64 + 430.
    EXPECT_NE(svg.find("x=\"299\" y=\"171.5\" width=\"215\" height=\"215\" class=\"keepout\""),
              std::string::npos)
        << svg;
    EXPECT_NE(svg.find("x=\"277.5\" y=\"150\" width=\"258\" height=\"258\" class=\"near\""),
              std::string::npos);
    EXPECT_NE(svg.find("x=\"729\" y=\"64\" width=\"21.5\" height=\"430\" class=\"keepout\""),
              std::string::npos);
    EXPECT_NE(svg.find("cx=\"836.5\" cy=\"279\" r=\"43\" class=\"keepout\""), std::string::npos);
    EXPECT_NE(svg.find("a &lt;machine&gt;"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
}

}  // namespace
}  // namespace takt::record
