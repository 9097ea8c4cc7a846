#include <gtest/gtest.h>

#include <optional>

#include "machine_base.hpp"

namespace takt::config {
namespace {

class DriveObjects : public test::MachineFile {
protected:
    static const fieldbus::StartupObject* find(const fieldbus::SlaveParams& slave,
                                               std::uint16_t index, std::uint8_t subindex = 0) {
        const fieldbus::StartupObject* found = nullptr;
        for (const auto& object : slave.startup) {
            if (object.index != index || object.subindex != subindex) continue;
            EXPECT_EQ(found, nullptr) << "twice: " << std::hex << index;
            found = &object;
        }
        return found;
    }
    static std::optional<std::int64_t> value(const fieldbus::SlaveParams& slave,
                                             std::uint16_t index, std::uint8_t subindex = 0) {
        const auto* const object = find(slave, index, subindex);
        if (object == nullptr) return std::nullopt;
        std::int64_t result = 0;
        for (std::size_t i = 0; i < object->data.size(); ++i)
            result |= std::int64_t{object->data[i]} << (8U * i);
        return result;
    }
};

TEST_F(DriveObjects, MakeACd300eRampInsteadOfCoasting) {
    const auto machine = loadText(test::BaseMachine).machine;
    ASSERT_TRUE(machine);
    const auto& slave = machine->network.slaves[0];
    EXPECT_EQ(value(slave, 0x605A), 1);
    EXPECT_EQ(find(slave, 0x605A)->data.size(), 2U);
    EXPECT_TRUE(find(slave, 0x605A)->required);
    EXPECT_EQ(value(slave, 0x605C), 1);
    // 2000 mm/s² at 500 counts/mm.
    EXPECT_EQ(value(slave, 0x6084), 1'000'000);
    EXPECT_EQ(value(slave, 0x6085), 1'000'000);
}

TEST_F(DriveObjects, CarryHomingInCountsToACd300e) {
    const auto machine = loadText(test::BaseMachine).machine;
    ASSERT_TRUE(machine);
    const auto& slave = machine->network.slaves[0];
    EXPECT_EQ(value(slave, 0x6098), 19);
    EXPECT_EQ(value(slave, 0x6099, 1), 25'000) << "50 mm/s at 500 counts/mm";
    EXPECT_EQ(value(slave, 0x6099, 2), 2'500);
    EXPECT_EQ(value(slave, 0x609A), 500'000);
    EXPECT_NE(find(slave, 0x6098)->origin.find("axis 'X'"), std::string::npos);
}

TEST_F(DriveObjects, CarryHomingInTenthsOfRpmToAnRa) {
    const auto result =
        loadWith("<Homing method=\"35\"/>",
                 "<Homing method=\"19\" switchSpeed=\"36 deg/s\" zeroSpeed=\"3.6 deg/s\" "
                 "acceleration=\"360 deg/s^2\"/>");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    const auto& slave = result.machine->network.slaves[1];
    // 36 deg/s behind a gear of 10 is one motor turn per second: 60 rpm.
    EXPECT_EQ(value(slave, 0x6099, 1), 600);
    EXPECT_EQ(value(slave, 0x6099, 2), 60);
    EXPECT_EQ(value(slave, 0x609A), 6'000);
    EXPECT_EQ(value(slave, 0x6085), 60'000);
    EXPECT_FALSE(value(slave, 0x605A)) << "the drive has no such object";
}

TEST_F(DriveObjects, LeaveOutSpeedsWhereHomingDoesNotMove) {
    const auto machine = loadText(test::BaseMachine).machine;
    ASSERT_TRUE(machine);
    EXPECT_EQ(value(machine->network.slaves[1], 0x6098), 35);
    EXPECT_FALSE(value(machine->network.slaves[1], 0x6099, 1));
}

TEST_F(DriveObjects, GiveWayToTheUser) {
    const auto result = loadWith("<Startup index=\"0x6065\" value=\"20000\"/>",
                                 "<Startup index=\"0x605A\" value=\"3\" required=\"false\"/>");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    const auto& slave = result.machine->network.slaves[0];
    EXPECT_EQ(value(slave, 0x605A), 3);
    EXPECT_FALSE(find(slave, 0x605A)->required);
}

TEST_F(DriveObjects, StandBehindThoseOfTheUser) {
    const auto machine = loadText(test::BaseMachine).machine;
    ASSERT_TRUE(machine);
    EXPECT_EQ(machine->network.slaves[0].startup.front().index, 0x6065);
    EXPECT_EQ(value(machine->network.slaves[0], 0x6065), 20'000);
}

TEST_F(DriveObjects, AreNotWrittenToASlaveWithoutAxis) {
    const auto result =
        loadWith("  </Network>", "<Slave name=\"spare\" device=\"CD300E\"/>\n  </Network>");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_TRUE(result.machine->network.slaves[2].startup.empty());
}

TEST_F(DriveObjects, BringADefaultIntoTheRangeOfTheDrive) {
    const auto result = loadWith("<Homing method=\"35\"/>", "<Homing method=\"19\"/>");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_EQ(value(result.machine->network.slaves[1], 0x609A), 10'000)
        << "3600 deg/s² would be 60000";
}

}  // namespace
}  // namespace takt::config
