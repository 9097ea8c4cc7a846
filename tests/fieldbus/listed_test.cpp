#include <gmock/gmock.h>

#include <functional>
#include <takt/fieldbus/pdo_layout.hpp>

#include "listed_network.hpp"
#include "twin_machine.hpp"

namespace {

using namespace takt;
using core::ObjectState;
using fieldbus::ethercat::NetworkState;
using std::chrono::milliseconds;
using test::TwinMachine;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

twin::TwinParams drives(std::size_t count) {
    auto params = twin::test::lineOf(count, "generic");
    params.hostPpm = -20.0;
    params.wakeJitter = std::chrono::microseconds{20};
    return params;
}

/// Two drives on a listed network, the list changed in one place.
class ListedNetwork : public testing::Test {
protected:
    using Change = std::function<void(fieldbus::NetworkParams&)>;

    TwinMachine& start(const Change& change = {}) {
        auto network = TwinMachine::networkOf(drives(2), milliseconds{1});
        test::makeListed(network);
        if (change) change(network);
        machine_.emplace(drives(2), network);
        return *machine_;
    }
    std::vector<fieldbus::ethercat::BringUpProblem> problems() {
        return machine_->master().bringUp({});
    }
    static fieldbus::ListedCommand& find(fieldbus::SlaveParams& slave, const std::string& comment,
                                         fieldbus::Transition transition) {
        for (auto& command : slave.listed->commands) {
            if (command.comment == comment && command.transitions.has(transition)) return command;
        }
        throw std::logic_error{"no such command"};
    }

private:
    std::optional<TwinMachine> machine_;
};

TEST_F(ListedNetwork, ComesUpAsTheListSays) {
    TwinMachine& machine = start();
    ASSERT_THAT(machine.bringUp(), IsEmpty());
    EXPECT_EQ(machine.twin().probe(1).alState, wire::AlState::PreOp);
    ASSERT_TRUE(machine.toOp()) << machine.master().problem();
    machine.cycle(100);
    EXPECT_EQ(machine.twin().probe(1).alState, wire::AlState::Op);
    EXPECT_TRUE(machine.master().image(1).health->inputsFresh);
    EXPECT_EQ(machine.master().expectedWorkingCounter(), 6);
    EXPECT_EQ(machine.master().counters().workingCounterErrors, 0U);
    EXPECT_GT(machine.twin().probe(1).cycles, 100U) << "SYNC0 runs";
    EXPECT_EQ(machine.twin().probe(1).missedOutputs, 0U);
}

TEST_F(ListedNetwork, CarriesTheBytesOfEachDeviceWhereTheListPutsThem) {
    TwinMachine& machine = start();
    ASSERT_THAT(machine.bringUp(), IsEmpty());
    ASSERT_TRUE(machine.toOp());
    const auto image = machine.master().image(1);
    ASSERT_EQ(image.outputs.size(), test::OutputBytes);
    ASSERT_EQ(image.inputs.size(), test::InputBytes);
    const auto& slave = machine.network().slaves[1];
    const auto control = fieldbus::findEntry(slave, fieldbus::Direction::Outputs, 0x6040, 0);
    core::write(image.outputs, control, 0x0006);
    machine.cycle(20);
    EXPECT_EQ(machine.twin().probe(1).driveState, core::cia402::DriveState::ReadyToSwitchOn);
    EXPECT_EQ(machine.twin().probe(0).driveState, core::cia402::DriveState::SwitchOnDisabled);
    const auto status = fieldbus::findEntry(slave, fieldbus::Direction::Inputs, 0x6041, 0);
    EXPECT_EQ(core::readUnsigned(image.inputs, status) & 0x6FU, 0x21U);
}

TEST_F(ListedNetwork, GoesDownAsTheListSays) {
    TwinMachine& machine = start();
    ASSERT_THAT(machine.bringUp(), IsEmpty());
    ASSERT_TRUE(machine.toOp());
    machine.master().requestInit();
    machine.cycle(200);
    EXPECT_EQ(machine.master().state(), NetworkState::Init);
    EXPECT_EQ(machine.twin().probe(0).alState, wire::AlState::Init);
    EXPECT_EQ(machine.twin().probe(1).alState, wire::AlState::Init);
}

TEST_F(ListedNetwork, GoesDownByItselfWhereTheListHasNoWay) {
    TwinMachine& machine = start([](auto& network) {
        for (auto& slave : network.slaves) slave.listed->commands.resize(16);  // up to OP
    });
    ASSERT_THAT(machine.bringUp(), IsEmpty());
    ASSERT_TRUE(machine.toOp());
    machine.master().requestInit();
    machine.cycle(200);
    EXPECT_EQ(machine.master().state(), NetworkState::Init);
    EXPECT_EQ(machine.twin().probe(1).alState, wire::AlState::Init);
}

TEST_F(ListedNetwork, IsLedUpAgainAfterACutCable) {
    TwinMachine& machine = start();
    ASSERT_THAT(machine.bringUp(), IsEmpty());
    ASSERT_TRUE(machine.toOp());
    machine.twin().cutCable(true);
    machine.cycle(150);
    machine.twin().cutCable(false);
    machine.cycle(20);
    EXPECT_FALSE(machine.master().image(0).health->operational);
    machine.master().requestOp();
    machine.cycle(500);
    EXPECT_TRUE(machine.master().image(0).health->operational);
    EXPECT_TRUE(machine.master().image(1).health->operational);
}

TEST_F(ListedNetwork, ComesUpAgainAfterItWentDown) {
    TwinMachine& machine = start();
    ASSERT_THAT(machine.bringUp(), IsEmpty());
    ASSERT_TRUE(machine.toOp());
    machine.master().requestInit();
    machine.cycle(200);
    EXPECT_THAT(machine.bringUp(), IsEmpty());
    EXPECT_TRUE(machine.toOp()) << machine.master().problem();
}

TEST_F(ListedNetwork, RefusesADeviceOfAnotherIdentityWithTheLineOfTheList) {
    start([](auto& network) {
        auto other = std::make_shared<wire::DeviceDescription>(*network.slaves[1].device);
        other->identity.product = 0x99;
        network.slaves[1].device = other;
        network.slaves[1].origin = "list.xml:77";
    });
    const auto told = problems();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].origin, "list.xml:77");
    EXPECT_THAT(told[0].text, AllOf(HasSubstr("expected product 0x00000099, found 0x00000042"),
                                    HasSubstr("check the network file")));
}

TEST_F(ListedNetwork, StopsAtAWorkingCounterThatIsNotTheListed) {
    start([](auto& network) { network.listed->commands[0].workingCounter = 3; });
    const auto told = problems();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].origin, "list.xml:count devices");
    EXPECT_EQ(told[0].text,
              "network: the init command 'count devices' came back with working counter 2, "
              "expected 3");
}

TEST_F(ListedNetwork, StopsAtAValidationThatDoesNotComeTrue) {
    start([](auto& network) {
        auto check = test::write(fieldbus::Transition::InitToPreOp, 2002, 0x0004, {0}, "FMMUs");
        check.command = 4;
        check.validation = {{99}, {0xFF}, milliseconds{20}};
        network.slaves[1].listed->commands.insert(network.slaves[1].listed->commands.begin() + 1,
                                                  check);
    });
    const auto told = problems();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].slave, "D1");
    EXPECT_EQ(told[0].origin, "list.xml:FMMUs");
    EXPECT_THAT(told[0].text, HasSubstr("the init command 'FMMUs' reads"));
    EXPECT_THAT(told[0].text, HasSubstr("expected 0x63"));
}

TEST_F(ListedNetwork, TellsWhyADeviceRefusesAState) {
    TwinMachine& machine = start([](auto& network) {
        auto& command = find(network.slaves[1], "SM2", fieldbus::Transition::PreOpToSafeOp);
        command.data = test::syncManager(0x1100, 6, 0x64);
    });
    ASSERT_THAT(machine.bringUp(), IsEmpty());
    EXPECT_FALSE(machine.toOp());
    EXPECT_THAT(machine.master().problem(),
                AllOf(HasSubstr("refuses SAFEOP"), HasSubstr("AL status code 0x001d")));
}

TEST_F(ListedNetwork, NamesTheCommandThatFailsInTheCycle) {
    TwinMachine& machine = start([](auto& network) {
        find(network.slaves[0], "ask for a state", fieldbus::Transition::SafeOpToOp)
            .workingCounter = 2;
    });
    ASSERT_THAT(machine.bringUp(), IsEmpty());
    EXPECT_FALSE(machine.toOp());
    EXPECT_THAT(machine.master().problem(),
                AllOf(HasSubstr("'ask for a state' came back with working counter 1, expected 2"),
                      HasSubstr("list.xml:ask for a state")));
}

TEST_F(ListedNetwork, SendsCommandsToAllBeforeAndAfterThoseOfTheDevices) {
    for (const bool before : {true, false}) {
        TwinMachine& machine = start([before](auto& network) {
            auto command =
                test::write(fieldbus::Transition::SafeOpToOp, 0, 0x0130, {0, 0}, "look at all");
            command.command = 7;  // BRD
            command.workingCounter = 9;
            command.beforeSlaves = before;
            network.listed->commands.push_back(command);
        });
        ASSERT_THAT(machine.bringUp(), IsEmpty());
        EXPECT_FALSE(machine.toOp());
        EXPECT_THAT(machine.master().problem(),
                    HasSubstr("network: the init command 'look at all' came back with working "
                              "counter 2, expected 9"));
        const auto state = before ? wire::AlState::SafeOp : wire::AlState::Op;
        EXPECT_EQ(machine.twin().probe(1).alState, state);
    }
}

TEST_F(ListedNetwork, WritesListedObjectsOnTheWayToSafeOp) {
    TwinMachine& machine = start([](auto& network) {
        fieldbus::ListedObject object;
        object.transitions.add(fieldbus::Transition::PreOpToSafeOp);
        object.index = 0x6065;
        object.data = {0x39, 0x30, 0, 0};
        network.slaves[0].listed->objects.push_back(object);
    });
    ASSERT_THAT(machine.bringUp(), IsEmpty());
    auto& objects = machine.master().objects(0);
    ASSERT_TRUE(objects.startRead({0x6065, 0}));
    for (int i = 0; i < 100 && objects.reply().state == ObjectState::Pending; ++i) machine.cycle();
    ASSERT_EQ(objects.reply().state, ObjectState::Done);
    const core::ObjectValue value = objects.reply().value;
    EXPECT_EQ(value.size, 4);
    EXPECT_EQ(wire::load32(value.bytes, 0), 12345U);
}

TEST_F(ListedNetwork, NamesAListedObjectThatIsRefused) {
    start([](auto& network) {
        fieldbus::ListedObject object;
        object.transitions.add(fieldbus::Transition::PreOpToSafeOp);
        object.index = 0x5FFF;
        object.data = test::Bytes(20);  // longer than any single value
        object.origin = "list.xml:12";
        network.slaves[0].listed->objects.push_back(object);
    });
    const auto told = problems();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_THAT(told[0].text, HasSubstr("refuses object 5FFFh:00 (list.xml:12)"));
}

/// RxPDO 1600h as a whole: mode, controlword, target, in another order than the device's own.
fieldbus::ListedObject wholeMapping() {
    fieldbus::ListedObject object;
    object.transitions.add(fieldbus::Transition::PreOpToSafeOp);
    object.index = 0x1600;
    object.completeAccess = true;
    object.data = {3, 0, 0x08, 0, 0x60, 0x60, 0x10, 0, 0x40, 0x60, 0x20, 0, 0x7A, 0x60};
    return object;
}

TEST_F(ListedNetwork, WritesAnObjectAsAWhole) {
    auto devices = TwinMachine::networkOf(drives(1), milliseconds{1});
    auto device = std::make_shared<wire::DeviceDescription>(*devices.slaves[0].device);
    device->mailbox->completeAccess = true;
    devices.slaves[0].device = device;
    test::makeListed(devices);
    devices.slaves[0].listed->objects.push_back(wholeMapping());
    devices.slaves[0].outputs[0].entries = {{0x6060, 0, 8}, {0x6040, 0, 16}, {0x607A, 0, 32}};
    twin::Twin segment{drives(1), {device}, milliseconds{1}};
    fieldbus::ethercat::Master master{devices, segment.link(), segment.clock()};
    ASSERT_TRUE(master.bringUp({}).empty());
    auto& objects = master.objects(0);
    ASSERT_TRUE(objects.startRead({0x1600, 2}));
    for (std::uint64_t k = 0; objects.reply().state == ObjectState::Pending && k < 100; ++k) {
        segment.clock().sleepUntil(segment.clock().now() + milliseconds{1});
        master.exchange(k);
        master.prepare();
    }
    ASSERT_EQ(objects.reply().state, ObjectState::Done);
    const core::ObjectValue value = objects.reply().value;
    EXPECT_EQ(wire::load32(value.bytes, 0), 0x60400010U);
}

TEST_F(ListedNetwork, TakesARefusedCompleteAccessForAnAnswer) {
    start([](auto& network) { network.slaves[0].listed->objects.push_back(wholeMapping()); });
    const auto told = problems();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_THAT(told[0].text, HasSubstr("refuses object 1600h:00"));
    EXPECT_THAT(told[0].text, HasSubstr("abort 0x06010004"));
}

TEST_F(ListedNetwork, SaysSoWhenTheListTakesTheTimeFromAnotherDevice) {
    start([](auto& network) {
        network.listed->frames[0][0].address = 0x0910'FFFF;  // the second one
    });
    const auto told = problems();
    ASSERT_EQ(told.size(), 1U);
    EXPECT_THAT(told[0].text, HasSubstr("takes the time from another device"));
}

TEST_F(ListedNetwork, RunsAlikeToTheLastNanosecond) {
    const auto run = [this] {
        TwinMachine& machine = start();
        EXPECT_THAT(machine.bringUp(), IsEmpty());
        EXPECT_TRUE(machine.toOp());
        std::vector<std::int64_t> samples;
        for (int i = 0; i < 200; ++i) {
            machine.cycle();
            samples.push_back(machine.master().dcSample().referenceTime.time_since_epoch().count());
        }
        return samples;
    };
    EXPECT_EQ(run(), run());
}

}  // namespace
