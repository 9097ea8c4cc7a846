#include <gtest/gtest.h>

#include <takt/record/event_log.hpp>

namespace takt::record {
namespace {

EventFormatter formatter() {
    return EventFormatter{
        {{7, "following error {0} mm, limit {1} mm"}, {8, "drive error {x0} ({0}) {y}"}},
        {"X", "Y"}};
}

TEST(EventLog, GivesEventsBackInOrder) {
    EventLog log{4};
    log.add({1, 7, 0, {}});
    log.add({2, 8, 1, {}});
    Event event;
    ASSERT_TRUE(log.next(event));
    EXPECT_EQ(event.cycle, 1U);
    ASSERT_TRUE(log.next(event));
    EXPECT_EQ(event.cycle, 2U);
    EXPECT_FALSE(log.next(event));
}

TEST(EventLog, CountsWhatItHadNoRoomFor) {
    EventLog log{2};
    for (core::CycleNumber i = 0; i < 5; ++i) log.add({i, 7, 0, {}});
    EXPECT_EQ(log.dropped(), 3U);
    Event event;
    ASSERT_TRUE(log.next(event));
    EXPECT_EQ(event.cycle, 0U);
}

TEST(EventFormatter, PutsTheNumbersIntoTheSentence) {
    EXPECT_EQ(formatter().format({1234, 7, 0, {2.5, 2.0}}),
              "cycle 1234 X: following error 2.5 mm, limit 2 mm");
}

TEST(EventFormatter, WritesHexadecimalWhereAsked) {
    EXPECT_EQ(formatter().format({5, 8, 1, {0x3130}}), "cycle 5 Y: drive error 0x3130 (12592) {y}");
    EXPECT_EQ(formatter().format({5, 8, 1, {0x1A}}), "cycle 5 Y: drive error 0x001A (26) {y}");
    EXPECT_EQ(formatter().format({5, 8, 1, {0x603F0010}}),
              "cycle 5 Y: drive error 0x603F0010 (1614741520) {y}");
}

TEST(EventFormatter, ShowsUnknownEventsAndSourcesByNumber) {
    EXPECT_EQ(formatter().format({9, 99, 12, {1, 2, 3, 4}}),
              "cycle 9 source 12: event 99 with 1, 2, 3, 4");
}

}  // namespace
}  // namespace takt::record
