#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <takt/record/plot_data.hpp>

namespace takt::record {
namespace {

const std::vector<TraceColumn> columns{{"t_ns", ColumnKind::Integer, {}},
                                       {"v", ColumnKind::Real, {}},
                                       {"s", ColumnKind::Text, {"A", "B"}}};
const std::vector<std::string> wantedColumns{"v", "s"};

void take(PlotData& data, std::int64_t ms, double value, std::int64_t state = 0) {
    const TraceCell row[] = {TraceCell{.integer = ms * 1000000}, TraceCell{.real = value},
                             TraceCell{.integer = state}};
    data.take(row);
}

TEST(PlotData, KeepsShortTracesPointByPoint) {
    PlotData data{columns, "t_ns", wantedColumns, 8};
    for (int i = 0; i < 5; ++i) take(data, i, i * 2.0);
    const auto curve = data.curve("v");
    ASSERT_EQ(curve.size(), 5U);
    EXPECT_EQ(curve[3].low, 6.0);
    EXPECT_EQ(curve[3].high, 6.0);
    EXPECT_DOUBLE_EQ(curve[3].lowTime, 0.003);
}

TEST(PlotData, NeverHoldsMoreBinsThanAskedFor) {
    PlotData data{columns, "t_ns", wantedColumns, 8};
    for (int i = 0; i < 1000; ++i) {
        take(data, i, i);
        ASSERT_LE(data.curve("v").size(), 8U);
    }
    EXPECT_GE(data.curve("v").size(), 4U);
}

TEST(PlotData, NeverLosesAPeakOfOneRow) {
    for (int peak = 0; peak < 300; peak += 7) {
        PlotData data{columns, "t_ns", wantedColumns, 10};
        for (int i = 0; i < 300; ++i) take(data, i, i == peak ? 99.0 : 1.0);
        double high = 0.0;
        for (const PlotBin& bin : data.curve("v")) high = std::max(high, bin.high);
        EXPECT_EQ(high, 99.0) << peak;
    }
}

TEST(PlotData, BinsCoverTheRowsWithoutGapOrOverlap) {
    PlotData data{columns, "t_ns", wantedColumns, 7};
    for (int i = 0; i < 500; ++i) take(data, i, i);
    const auto curve = data.curve("v");
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
        EXPECT_EQ(curve[i].high + 1.0, curve[i + 1].low) << i;
        EXPECT_DOUBLE_EQ(curve[i].lowTime * 1000.0, curve[i].low) << i;
    }
    EXPECT_EQ(curve.front().low, 0.0);
    EXPECT_EQ(curve.back().high, 499.0);
}

TEST(PlotData, RemembersWhenTheExtremesWereReached) {
    PlotData data{columns, "t_ns", wantedColumns, 2};
    take(data, 0, 0.0);
    take(data, 1, 5.0);
    take(data, 2, 5.0);
    take(data, 3, 0.0);
    const auto curve = data.curve("v");
    ASSERT_EQ(curve.size(), 2U);
    EXPECT_LT(curve[0].lowTime, curve[0].highTime);
    EXPECT_GT(curve[1].lowTime, curve[1].highTime);
}

TEST(PlotData, LeavesOutValuesThatAreNoNumbers) {
    PlotData data{columns, "t_ns", wantedColumns, 2};
    take(data, 0, std::numeric_limits<double>::quiet_NaN());
    take(data, 1, 3.0);
    take(data, 2, 4.0);
    const auto curve = data.curve("v");
    ASSERT_EQ(curve.size(), 2U);
    EXPECT_TRUE(curve[0].valid);
    EXPECT_EQ(curve[0].low, 3.0);
}

TEST(PlotData, KeepsStatesAsRuns) {
    PlotData data{columns, "t_ns", wantedColumns, 4};
    for (int i = 0; i < 100; ++i) take(data, i, 0.0, i >= 40 && i < 41 ? 1 : 0);
    const auto runs = data.runs("s");
    ASSERT_EQ(runs.size(), 3U);
    EXPECT_DOUBLE_EQ(runs[1].begin, 0.040);
    EXPECT_EQ(runs[1].value, 1U);
    EXPECT_DOUBLE_EQ(runs[2].begin, 0.041);
}

TEST(PlotData, BoundsTheRunsOfAFlickeringState) {
    PlotData data{columns, "t_ns", wantedColumns, 4};
    for (int i = 0; i < 100000; ++i) take(data, i, 0.0, i % 2);
    EXPECT_LE(data.runs("s").size(), 8192U);
    PlotData still{columns, "t_ns", wantedColumns, 4};
    for (int i = 0; i < 20000; ++i) take(still, 0, 0.0, i % 2);
    EXPECT_LE(still.runs("s").size(), 8192U);
}

TEST(PlotData, GivesNothingForAColumnItDoesNotKeep) {
    const std::vector<std::string> wanted{"v", "missing"};
    const PlotData data{columns, "t_ns", wanted, 4};
    EXPECT_TRUE(data.curve("missing").empty());
    EXPECT_TRUE(data.runs("s").empty());
    EXPECT_TRUE(data.names("s").empty());
}

TEST(PlotData, RefusesATraceWithoutTime) {
    EXPECT_THROW(PlotData(columns, "time", wantedColumns, 4), std::invalid_argument);
    EXPECT_THROW(PlotData(columns, "v", wantedColumns, 4), std::invalid_argument);
}

}  // namespace
}  // namespace takt::record
