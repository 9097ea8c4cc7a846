#include <gtest/gtest.h>

#include <algorithm>
#include <takt/record/csv_trace.hpp>
#include <takt/record/motion_trace.hpp>

#include "temporary_file.hpp"

namespace takt::record {
namespace {

const std::vector<std::string> stateNames{"Disabled", "Standstill"};

TEST(MotionTrace, HasTheColumnsThatItsReadersExpect) {
    const std::vector<MotionAxis> axes{{"X", "mm"}};
    std::string names;
    for (const TraceColumn& column : motionColumns(axes, stateNames)) names += column.name + " ";
    EXPECT_EQ(names,
              "cycle t_ns X.state X.set X.setVel X.setAcc X.target X.actual X.actualVel X.lag "
              "X.controlword X.statusword X.mode X.error ");
}

TEST(MotionTrace, WritesEverySampleIntoItsColumn) {
    const test::TemporaryFile temporary{".csv"};
    const std::vector<MotionAxis> axes{{"X", "mm"}};
    TraceRecorder trace{motionColumns(axes, stateNames), 8};
    TraceRow row = trace.row();
    putCycle(row, 3, core::HostTime{std::chrono::milliseconds{3}});
    putAxis(row, {1, 1.5, 2.5, 3.5, -4, 5.5, 6.5, 7.5, 15, 0x1637, 8, 9});
    row.commit();
    OutputFile file{temporary.path()};
    CsvTrace csv{file, trace.columns()};
    TraceSink* sinks[] = {&csv};
    trace.drain(sinks);
    csv.finish();
    const std::string text = temporary.content();
    EXPECT_EQ(text.substr(text.find('\n') + 1),
              "3,3000000,Standstill,1.5,2.5,3.5,-4,5.5,6.5,7.5,15,5687,8,9\n");
}

TEST(MotionPlot, ShowsOnlyColumnsThatTheTraceHas) {
    const std::vector<MotionAxis> axes{{"X", "mm"}, {"C", "deg"}};
    const auto columns = motionColumns(axes, stateNames);
    for (const std::string& name : columnsOf(motionPlot("t", "", axes))) {
        EXPECT_TRUE(std::any_of(columns.begin(), columns.end(), [&](const TraceColumn& c) {
            return c.name == name;
        })) << name;
    }
}

TEST(MotionPlot, GivesEveryUnitAPanelOfItsOwn) {
    const std::vector<MotionAxis> axes{{"X", "mm"}, {"C", "deg"}, {"Y", "mm"}};
    const PlotSpec spec = motionPlot("t", "", axes);
    ASSERT_EQ(spec.panels.size(), 8U);
    EXPECT_EQ(spec.panels[0].unit, "mm");
    EXPECT_EQ(spec.panels[1].unit, "deg");
    EXPECT_EQ(spec.panels[0].curves.size(), 4U);
    EXPECT_EQ(spec.panels[1].curves.size(), 2U);
}

}  // namespace
}  // namespace takt::record
