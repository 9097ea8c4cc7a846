#include "machine_base.hpp"

namespace takt::config::test {
namespace {

const std::string Place = "  <Twin clock=\"12 ppm\" wakeJitter=\"30 us\">";

using MachineStopFile = MachineFile;

TEST_F(MachineStopFile, IsOffForFaultsWithoutTheElement) {
    const auto result = loadText(BaseMachine);
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_FALSE(result.machine->machineStop.onFault);
    EXPECT_TRUE(result.machine->machineStop.inputs.empty());
}

TEST_F(MachineStopFile, BindsAnInputOfAnAxisToItsDrivesDigitalInputs) {
    const auto result = loadWith(Place,
                                 "<MachineStop time=\"500 ms\"><Input axis=\"Z\" bit=\"4\" "
                                 "active=\"high\"/></MachineStop>\n" +
                                     Place);
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    const axis::MachineStopParams& stop = result.machine->machineStop;
    EXPECT_EQ(stop.time, std::chrono::milliseconds{500});
    EXPECT_TRUE(stop.onFault);
    ASSERT_EQ(stop.inputs.size(), 1U);
    EXPECT_EQ(stop.inputs[0].slave, "z");
    EXPECT_EQ(stop.inputs[0].index, 0x60FD);
    EXPECT_EQ(stop.inputs[0].bit, 4);
    EXPECT_TRUE(stop.inputs[0].activeHigh);
}

TEST_F(MachineStopFile, CountsALowBitAsActiveUnlessToldOtherwise) {
    const auto result = loadWith(
        Place,
        "<MachineStop><Input slave=\"z\" index=\"0x60FD\" bit=\"16\"/></MachineStop>\n" + Place);
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_FALSE(result.machine->machineStop.inputs[0].activeHigh);
}

TEST_F(MachineStopFile, RefusesAnInputThatIsNotMapped) {
    expectError(
        Place,
        "<MachineStop><Input slave=\"z\" index=\"0x6077\" bit=\"0\"/></MachineStop>\n" + Place,
        "not among the inputs of slave 'z'", "a mapped entry");
}

TEST_F(MachineStopFile, RefusesABitThatTheEntryDoesNotHave) {
    expectError(
        Place,
        "<MachineStop><Input slave=\"z\" index=\"0x6061\" bit=\"8\"/></MachineStop>\n" + Place,
        "the entry has 8 bits", "0 to 7");
}

TEST_F(MachineStopFile, RefusesAnInputOnAxisAndSlave) {
    expectError(Place,
                "<MachineStop><Input axis=\"Z\" slave=\"z\" bit=\"0\"/></MachineStop>\n" + Place,
                "neither on one axis nor on one slave", "either axis");
}

TEST_F(MachineStopFile, RefusesAnAxisThatDoesNotExist) {
    expectError(Place, "<MachineStop><Input axis=\"Q\" bit=\"0\"/></MachineStop>\n" + Place,
                "there is no axis 'Q'", "");
}

}  // namespace
}  // namespace takt::config::test
