#include <algorithm>
#include <takt/wire/byte_io.hpp>

#include "master_fixture.hpp"

namespace {

using namespace takt;
using fieldbus::ethercat::NetworkState;
using test::MasterOnFake;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class MasterBringUp : public MasterOnFake {};

TEST_F(MasterBringUp, EndsInPreOpWithoutProblems) {
    build(test::exampleNetwork(3));
    EXPECT_THAT(bringUp(), IsEmpty());
    EXPECT_EQ(master->state(), NetworkState::PreOp);
}

TEST_F(MasterBringUp, NumbersStationsFrom1001InFrameOrder) {
    build(test::exampleNetwork(3));
    ASSERT_THAT(bringUp(), IsEmpty());
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(wire::load16(segment.devices[i].memory, 0x0010), 1001 + i);
    }
}

TEST_F(MasterBringUp, NamesBothSidesOfAWrongVendor) {
    build(test::exampleNetwork(3));
    segment.devices[2].eeprom[8] = 0x0000BAD0;
    EXPECT_THAT(bringUp(),
                ElementsAre("slave 2 'z': expected vendor 0x00000a0b, found 0x0000bad0; check the "
                            "ESI file or the order of the devices"));
    EXPECT_EQ(master->state(), NetworkState::Off);
}

TEST_F(MasterBringUp, NamesEveryDeviceThatDiffers) {
    build(test::exampleNetwork(3));
    segment.devices[0].eeprom[10] = 1;
    segment.devices[1].eeprom[12] = 0x00010001;
    const auto lines = bringUp();
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_THAT(lines[0], StartsWith("slave 0 'x': expected product 0x00c0ffee, found 0x00000001"));
    EXPECT_THAT(lines[1],
                StartsWith("slave 1 'y': expected revision 0x00010002, found 0x00010001"));
}

TEST_F(MasterBringUp, TakesANewerRevisionOnlyWhereTheRuleSaysSo) {
    auto params = test::exampleNetwork(2);
    params.slaves[0].revisionRule = fieldbus::RevisionRule::EqualOrGreater;
    params.slaves[1].revisionRule = fieldbus::RevisionRule::Ignore;
    build(params);
    segment.devices[0].eeprom[12] = 0x00010003;
    segment.devices[1].eeprom[12] = 0x00000001;
    EXPECT_THAT(bringUp(), IsEmpty());
    build(params);
    segment.devices[0].eeprom[12] = 0x00010001;
    EXPECT_THAT(bringUp(), ElementsAre(HasSubstr("expected revision 0x00010002 or greater")));
}

TEST_F(MasterBringUp, ListsAMissingDevice) {
    build(test::exampleNetwork(3));
    segment.devices.pop_back();
    const auto lines = bringUp();
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0], "network: expected 3 devices, found 2");
    EXPECT_THAT(lines[1], StartsWith("slave 2 'z': expected vendor 0x00000a0b"));
    EXPECT_THAT(lines[1], HasSubstr("found nothing"));
}

TEST_F(MasterBringUp, ListsADeviceTooMany) {
    build(test::exampleNetwork(2));
    segment.devices.emplace_back(test::exampleDrive());
    EXPECT_THAT(bringUp(), ElementsAre("network: expected 2 devices, found 3",
                                       StartsWith("slave 2: expected nothing, found vendor")));
}

TEST_F(MasterBringUp, TellsADeadLinkFromAnEmptyOne) {
    build(test::exampleNetwork(1));
    segment.down = true;
    EXPECT_THAT(bringUp(), ElementsAre(HasSubstr("link is down")));
    segment.down = false;
    segment.devices.clear();
    EXPECT_THAT(bringUp(), ElementsAre(HasSubstr("no device answers")));
}

TEST_F(MasterBringUp, SurvivesEveryTenthFrameLost) {
    build(test::exampleNetwork(3));
    for (std::uint64_t i = 5; i < 4000; i += 10) segment.lose.insert(i);
    EXPECT_THAT(bringUp(), IsEmpty());
}

TEST_F(MasterBringUp, RefusesAWatchdogThatIsOff) {
    auto params = test::exampleNetwork(1);
    params.slaves[0].watchdog = core::Duration{0};
    build(params);
    EXPECT_THAT(bringUp(), ElementsAre(HasSubstr("watchdog must not be off")));
    EXPECT_EQ(segment.frameNumber, 0U) << "nothing is sent to a machine that is refused";
}

TEST_F(MasterBringUp, RefusesDevicesOutOfFrameOrder) {
    auto params = test::exampleNetwork(2);
    std::swap(params.slaves[0], params.slaves[1]);
    build(params);
    EXPECT_THAT(bringUp(), ElementsAre(HasSubstr("slave 0 'y': is configured for position 1"),
                                       HasSubstr("slave 1 'x': is configured for position 0")));
}

TEST_F(MasterBringUp, RefusesStartUpObjectsThatAreTooLongOrEmpty) {
    auto params = test::exampleNetwork(1);
    params.slaves[0].startup = {{0x2010, 1, {}, true, "m.xml:3"},
                                {0x2010, 2, std::vector<std::uint8_t>(9), true, "m.xml:4"}};
    build(params);
    EXPECT_THAT(bringUp(), ElementsAre(HasSubstr("2010h:01 (m.xml:3) has 0 bytes"),
                                       HasSubstr("2010h:02 (m.xml:4) has 9 bytes")));
}

TEST_F(MasterBringUp, SendsNothingInCyclesBeforeOrAfterItFailed) {
    build(test::exampleNetwork(1));
    cycle(3);
    EXPECT_EQ(segment.frameNumber, 0U);
    segment.devices[0].eeprom[8] = 1;
    EXPECT_FALSE(bringUp().empty());
    const auto before = segment.frameNumber;
    cycle(3);
    EXPECT_EQ(segment.frameNumber, before);
}

TEST_F(MasterBringUp, RefusesAMailboxThatTheEepromPutsElsewhere) {
    build(test::exampleNetwork(1));
    segment.devices[0].eeprom[24] = 0x00801000 + 0x100;
    EXPECT_THAT(bringUp(),
                ElementsAre(HasSubstr("expected receive mailbox at 0x1000 with 128 bytes, found "
                                      "0x1100 with 128 bytes")));
}

TEST_F(MasterBringUp, MarksWhereTheConfigurationSaysIt) {
    build(test::exampleNetwork(2));
    segment.devices[1].eeprom[8] = 1;
    const auto problems = master->bringUp({});
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].slave, "y");
    EXPECT_EQ(problems[0].origin, "machine.xml:11");
}

TEST_F(MasterBringUp, WritesStartUpObjectsInOrder) {
    auto params = test::exampleNetwork(1);
    params.slaves[0].startup = {{0x6060, 0, {8}, true, "a"},
                                {0x607D, 1, {1, 2, 3, 4}, true, "b"},
                                {0x2010, 5, {1, 2, 3, 4, 5, 6, 7, 8}, true, "c"}};
    build(params);
    ASSERT_THAT(bringUp(), IsEmpty());
    const auto& device = segment.devices[0];
    EXPECT_THAT(device.written, ElementsAre(0x606000U, 0x607D01U, 0x201005U));
    EXPECT_THAT(device.objects.at(0x606000), ElementsAre(8));
    EXPECT_THAT(device.objects.at(0x201005), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
}

TEST_F(MasterBringUp, KeepsTheDeviceInPreOpWhenARequiredObjectIsRefused) {
    auto params = test::exampleNetwork(2);
    params.slaves[1].startup = {{0x605A, 0, {2, 0}, true, "machine.xml:31"}};
    build(params);
    segment.devices[1].aborts[0x605A00] = 0x06020000;
    EXPECT_THAT(bringUp(), ElementsAre("slave 1 'y': refuses object 605Ah:00 (machine.xml:31) with "
                                       "abort 0x06020000: object does not exist"));
    EXPECT_EQ(wire::load16(segment.devices[1].memory, 0x0130), 2);
}

TEST_F(MasterBringUp, OnlyNotesARefusedOptionalObject) {
    auto params = test::exampleNetwork(1);
    params.slaves[0].startup = {{0x605A, 0, {2, 0}, false, "machine.xml:31"}};
    build(params);
    segment.devices[0].aborts[0x605A00] = 0x06090030;
    std::vector<std::string> said;
    EXPECT_TRUE(master->bringUp([&](std::string_view line) { said.emplace_back(line); }).empty());
    EXPECT_THAT(said,
                Contains(HasSubstr("optional object 605Ah:00 refused with abort 0x06090030")));
}

TEST_F(MasterBringUp, NamesTheStateADeviceRefusesAndItsCode) {
    build(test::exampleNetwork(2));
    segment.devices[0].refusals[2] = 0x0016;
    EXPECT_THAT(bringUp(), ElementsAre(HasSubstr("slave 0 'x': refuses PREOP and stays in INIT, AL "
                                                 "status code 0x0016: invalid mailbox")));
}

TEST_F(MasterBringUp, GivesUpAMailboxThatNeverAnswers) {
    auto params = test::exampleNetwork(1);
    params.slaves[0].startup = {{0x6060, 0, {8}, true, {}}};
    build(params);
    segment.devices[0].mailboxSilent = true;
    EXPECT_THAT(bringUp(), ElementsAre(HasSubstr("abort 0x05040000")));
    EXPECT_EQ(segment.devices[0].receivedMail, 3U) << "two repetitions";
}

TEST_F(MasterBringUp, NeverTakesAnEmergencyForTheAnswer) {
    auto params = test::exampleNetwork(1);
    params.slaves[0].startup = {{0x6060, 0, {8}, true, {}}};
    build(params);
    segment.devices[0].emergency(0x8611);
    ASSERT_THAT(bringUp(), IsEmpty());
    EXPECT_THAT(segment.devices[0].objects.at(0x606000), ElementsAre(8));
    EXPECT_EQ(master->emergencies(0), 1U);
    EXPECT_EQ(master->lastEmergency(0).errorCode, 0x8611);
    EXPECT_EQ(master->lastEmergency(0).errorRegister, 0x81);
}

TEST_F(MasterBringUp, RewritesMappingsOnlyWithEmptyCounts) {
    auto params = test::exampleNetwork(1);
    auto& slave = params.slaves[0];
    slave.outputs[0].writeMapping = true;
    slave.outputs[0].entries.push_back({0x6060, 0, 8});
    build(params);
    ASSERT_THAT(bringUp(), IsEmpty());
    EXPECT_THAT(segment.devices[0].written,
                ElementsAre(0x1C1200U, 0x1C1300U, 0x160000U, 0x160100U, 0x160001U, 0x160002U,
                            0x160003U, 0x160000U, 0x1C1201U, 0x1C1200U, 0x1C1301U, 0x1C1300U));
    EXPECT_THAT(segment.devices[0].objects.at(0x160003), ElementsAre(0x08, 0x00, 0x60, 0x60));
    EXPECT_THAT(segment.devices[0].objects.at(0x1C1201), ElementsAre(0x00, 0x16));
    EXPECT_THAT(segment.devices[0].objects.at(0x1C1200), ElementsAre(1));
}

TEST_F(MasterBringUp, SetsUpSyncManagersFmmusAndWatchdog) {
    build(test::exampleNetwork(2));
    ASSERT_THAT(bringUp(), IsEmpty());
    const auto& memory = segment.devices[1].memory;
    const auto bytes = [&](std::size_t at, std::size_t count) {
        return std::vector<std::uint8_t>(memory.begin() + static_cast<std::ptrdiff_t>(at),
                                         memory.begin() + static_cast<std::ptrdiff_t>(at + count));
    };
    EXPECT_THAT(bytes(0x0810, 8), ElementsAre(0x00, 0x11, 6, 0, 0x64, 0, 1, 0));
    EXPECT_THAT(bytes(0x0818, 8), ElementsAre(0x00, 0x14, 6, 0, 0x20, 0, 1, 0));
    // Group at 0x10000: outputs of both devices (12 bytes), then inputs of both.
    EXPECT_THAT(bytes(0x0600, 13), ElementsAre(6, 0, 1, 0, 6, 0, 0, 7, 0x00, 0x11, 0, 2, 1));
    EXPECT_THAT(bytes(0x0610, 13), ElementsAre(18, 0, 1, 0, 6, 0, 0, 7, 0x00, 0x14, 0, 1, 1));
    EXPECT_THAT(bytes(0x0620, 13), ElementsAre(0, 0, 0, 9, 1, 0, 1, 1, 0x0D, 0x08, 3, 1, 1));
    EXPECT_EQ(wire::load16(memory, 0x0400), 2498);
    EXPECT_EQ(wire::load16(memory, 0x0420), 1000);
}

TEST_F(MasterBringUp, ArmsSync0OfAllDevicesOnOneGrid) {
    auto params = test::exampleNetwork(3);
    params.slaves[2].dc.sync0Shift = std::chrono::microseconds{125};
    build(params);
    ASSERT_THAT(bringUp(), IsEmpty());
    const auto start = [&](std::size_t i) {
        return wire::load64(segment.devices[i].memory, 0x0990);
    };
    EXPECT_EQ(start(0) % 1'000'000, 0U);
    EXPECT_EQ(start(1), start(0));
    EXPECT_EQ(start(2), start(0) + 125'000);
    for (const auto& device : segment.devices) {
        EXPECT_EQ(wire::load32(device.memory, 0x09A0), 1'000'000U);
        EXPECT_EQ(device.memory[0x0980], 0);
        EXPECT_EQ(device.memory[0x0981], 3);
    }
}

TEST_F(MasterBringUp, GivesEveryClockTheReferenceTimeAndItsDelay) {
    build(test::exampleNetwork(3));
    ASSERT_THAT(bringUp(), IsEmpty());
    // The fake line has 300 ns between devices, which show up in the local clocks as well.
    for (std::uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(wire::load32(segment.devices[i].memory, 0x0928), 300 * i);
        EXPECT_EQ(wire::load64(segment.devices[i].memory, 0x0920), 800'000'000'000'000'000U);
    }
}

TEST_F(MasterBringUp, FirstSendSitsOnTheGrid) {
    build(test::exampleNetwork(2));
    ASSERT_THAT(bringUp(), IsEmpty());
    const core::HostTime from = clock.now();
    const core::HostTime first = master->firstSend(from);
    EXPECT_GE(first, from);
    EXPECT_LT(first - from, network.cycle);
    clock.sleepUntil(first);
    master->exchange(0);
    ASSERT_TRUE(master->dcSample().valid);
    EXPECT_EQ(master->dcSample().phaseError, core::Duration{0});
}

TEST_F(MasterBringUp, SendsTheDevicesToInitWhenItsBringUpIsBrokenOff) {
    build(test::exampleNetwork(2));
    for (int until = 1; until < 12; ++until) {
        int asked = 0;
        const auto problems = master->bringUp({}, [&] { return ++asked < until; });
        ASSERT_EQ(problems.size(), 1U) << until;
        EXPECT_THAT(problems[0].text, testing::HasSubstr("broken off"));
        for (const auto& device : segment.devices)
            EXPECT_EQ(device.stateRequests.back() & 0x0FU, 0x01U) << until;
    }
    EXPECT_THAT(bringUp(), testing::IsEmpty()) << "and it can be brought up again";
}

}  // namespace
