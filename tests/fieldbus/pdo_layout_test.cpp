#include <gmock/gmock.h>

#include <takt/fieldbus/pdo_layout.hpp>

namespace {

using namespace takt;
using fieldbus::Direction;

fieldbus::SlaveParams oddDrive() {
    fieldbus::SlaveParams slave;
    slave.outputs = {{0x1600, {{0x6040, 0, 16}, {0x6060, 0, 8}, {0x607A, 0, 32}}, false},
                     {0x1601, {{0x60FE, 1, 3}, {0, 0, 5}, {0x60FE, 2, 32}}, false}};
    slave.inputs = {{0x1A00, {{0x6041, 0, 16}, {0x2000, 0, 64}, {0x60FD, 0, 1}}, false}};
    return slave;
}

TEST(PdoLayout, PutsEntriesOneBehindTheOtherWithoutAlignment) {
    const auto slave = oddDrive();
    const auto target = findEntry(slave, Direction::Outputs, 0x607A, 0);
    EXPECT_EQ(target.bitOffset, 24U);
    EXPECT_EQ(target.bitLength, 32);
}

TEST(PdoLayout, GoesOnInTheNextPdoOfTheAssignment) {
    const auto slot = findEntry(oddDrive(), Direction::Outputs, 0x60FE, 1);
    EXPECT_EQ(slot.bitOffset, 56U);
    EXPECT_EQ(slot.bitLength, 3);
}

TEST(PdoLayout, CountsGaps) {
    EXPECT_EQ(findEntry(oddDrive(), Direction::Outputs, 0x60FE, 2).bitOffset, 64U);
}

TEST(PdoLayout, FindsNothingInTheOtherDirectionOrSubindex) {
    EXPECT_FALSE(findEntry(oddDrive(), Direction::Inputs, 0x6040, 0).present());
    EXPECT_FALSE(findEntry(oddDrive(), Direction::Outputs, 0x6040, 1).present());
}

TEST(PdoLayout, BeginsBehindTheBitsOfAnother) {
    auto slave = oddDrive();
    slave.outputShift = 3;
    EXPECT_EQ(findEntry(slave, Direction::Outputs, 0x6060, 0).bitOffset, 19U);
    EXPECT_EQ(findEntry(slave, Direction::Inputs, 0x6041, 0).bitOffset, 0U);
    EXPECT_EQ(processDataBytes(slave, Direction::Outputs), 12U) << "the device knows no shift";
}

TEST(PdoLayout, NeverFindsAGap) {
    EXPECT_FALSE(findEntry(oddDrive(), Direction::Outputs, 0, 0).present());
}

TEST(PdoLayout, FindsNoEntryWiderThan32BitsButCountsIt) {
    EXPECT_FALSE(findEntry(oddDrive(), Direction::Inputs, 0x2000, 0).present());
    EXPECT_EQ(findEntry(oddDrive(), Direction::Inputs, 0x60FD, 0).bitOffset, 80U);
}

TEST(PdoLayout, RoundsBytesUp) {
    EXPECT_EQ(processDataBytes(oddDrive(), Direction::Outputs), 12U);
    EXPECT_EQ(processDataBytes(oddDrive(), Direction::Inputs), 11U);
    EXPECT_EQ(processDataBytes({}, Direction::Inputs), 0U);
}

}  // namespace
