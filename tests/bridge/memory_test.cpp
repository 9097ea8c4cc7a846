#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <takt/bridge/command_memory.hpp>
#include <takt/bridge/status_memory.hpp>
#include <thread>

namespace takt::bridge {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

StatusSetup twoAxes() {
    StatusSetup setup;
    setup.machine = "press";
    setup.cycle = 1ms;
    setup.dds = {.enabled = true, .everyCycles = 10, .domain = 3, .interface = "lo"};
    setup.axes = {{"X", "mm"}, {"C", "deg"}};
    setup.groups = {{"table", "mm"}};
    return setup;
}

TEST(StatusMemory, CarriesTheNamesAndSettingsOfTheMachine) {
    const StatusWriter writer{twoAxes()};
    const StatusReader reader{writer.descriptor()};
    EXPECT_EQ(view(reader.header().machine), "press");
    EXPECT_EQ(view(reader.header().interface), "lo");
    EXPECT_EQ(reader.header().domain, 3U);
    EXPECT_EQ(reader.header().everyCycles, 10U);
    EXPECT_FALSE(reader.header().commands);
    ASSERT_EQ(reader.axisNames().size(), 2U);
    EXPECT_EQ(view(reader.axisNames()[1].name), "C");
    EXPECT_EQ(view(reader.axisNames()[1].unit), "deg");
    ASSERT_EQ(reader.groupNames().size(), 1U);
    EXPECT_EQ(view(reader.groupNames()[0].name), "table");
}

TEST(StatusMemory, IsDueInEveryNthCycle) {
    const StatusWriter writer{twoAxes()};
    EXPECT_TRUE(writer.due(0));
    EXPECT_FALSE(writer.due(9));
    EXPECT_TRUE(writer.due(10));
}

TEST(StatusMemory, BringsEachSampleToItsOwnPlace) {
    StatusWriter writer{twoAxes()};
    StatusReader reader{writer.descriptor()};
    writer.axis(0, {.cycle = 10, .set = 1.5});
    writer.axis(1, {.cycle = 10, .set = -2.5, .state = AxisState::ErrorStop});
    writer.group(0, {.cycle = 10, .pathVelocity = 7.0, .state = GroupState::Moving});
    writer.machine({.cycle = 10, .framesLost = 4, .network = NetworkState::Op});
    writer.event({.number = 1, .cycle = 9, .text = {'h', 'o'}});
    writer.reply({.client = 5, .request = 6, .kind = ReplyKind::Done});

    AxisSample axis;
    ASSERT_TRUE(reader.axis(0, axis));
    EXPECT_EQ(axis.set, 1.5);
    ASSERT_TRUE(reader.axis(1, axis));
    EXPECT_EQ(axis.set, -2.5);
    EXPECT_EQ(axis.state, AxisState::ErrorStop);
    GroupSample group;
    ASSERT_TRUE(reader.group(0, group));
    EXPECT_EQ(group.pathVelocity, 7.0);
    MachineSample machine;
    ASSERT_TRUE(reader.machine(machine));
    EXPECT_EQ(machine.framesLost, 4U);
    EventRecord event;
    ASSERT_TRUE(reader.event(event));
    EXPECT_EQ(view(event.text), "ho");
    ReplyRecord reply;
    ASSERT_TRUE(reader.reply(reply));
    EXPECT_EQ(reply.request, 6U);
    EXPECT_FALSE(reader.axis(0, axis));
}

TEST(StatusMemory, KeepsTwoSecondsOfSamplesForABridgeThatIsKeptFromRunning) {
    StatusWriter writer{twoAxes()};
    StatusReader reader{writer.descriptor()};
    for (std::uint64_t i = 0; i < 200; ++i) writer.axis(0, {.cycle = 10 * i});
    AxisSample sample;
    for (std::uint64_t i = 0; i < 200; ++i) {
        ASSERT_TRUE(reader.axis(0, sample));
        EXPECT_EQ(sample.cycle, 10 * i);
    }
}

TEST(StatusMemory, TellsANewBridgeTheEventsOfBefore) {
    StatusWriter writer{twoAxes()};
    for (std::uint64_t i = 1; i <= 3; ++i) writer.event({.number = i});
    StatusReader reader{writer.descriptor()};
    EventRecord event;
    for (std::uint64_t i = 1; i <= 3; ++i) {
        ASSERT_TRUE(reader.event(event));
        EXPECT_EQ(event.number, i);
    }
}

TEST(StatusMemory, TellsANewBridgeNoReplyOfBefore) {
    StatusWriter writer{twoAxes()};
    writer.reply({.request = 1});
    StatusReader reader{writer.descriptor()};
    ReplyRecord reply;
    EXPECT_FALSE(reader.reply(reply));
    writer.reply({.request = 2});
    ASSERT_TRUE(reader.reply(reply));
    EXPECT_EQ(reply.request, 2U);
}

TEST(StatusMemory, CannotBeWrittenByWhoeverGetsItsDescriptor) {
    const StatusWriter writer{twoAxes()};
    EXPECT_THROW(SharedMemory::attach(writer.descriptor(), SharedMemory::Others::Write),
                 std::runtime_error);
    EXPECT_EQ(write(writer.descriptor(), "x", 1), -1);
    EXPECT_EQ(ftruncate(writer.descriptor(), 0), -1);
}

TEST(StatusMemory, OfAnotherVersionIsRefusedWithBothNumbers) {
    SharedMemory memory = SharedMemory::create("other", 1 << 20, SharedMemory::Others::Read);
    StatusHeader header;
    header.version = ProtocolVersion + 1;
    std::memcpy(memory.data(), &header, sizeof header);
    try {
        const StatusReader reader{memory.descriptor()};
        FAIL() << "accepted";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("version 2, this bridge knows 1"));
    }
}

TEST(StatusMemory, SmallerThanItsOwnCountsIsRefused) {
    SharedMemory memory = SharedMemory::create("small", 8192, SharedMemory::Others::Read);
    StatusHeader header;
    header.axes = 100;
    header.samples = 200;
    header.cycleNs = 1'000'000;
    std::memcpy(memory.data(), &header, sizeof header);
    EXPECT_THROW(StatusReader{memory.descriptor()}, std::runtime_error);
}

TEST(SharedMemory, WhoseSizeMayChangeIsRefused) {
    const int descriptor = memfd_create("loose", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    ASSERT_EQ(ftruncate(descriptor, 4096), 0);
    EXPECT_THROW(SharedMemory::attach(descriptor, SharedMemory::Others::Read), std::runtime_error);
    close(descriptor);
}

CommandRecord inch(std::uint64_t request) {
    CommandRecord command{.writer = 1, .client = 2, .request = request, .distance = 0.5};
    put(command.axis, "X");
    command.order = CommandOrder::Inch;
    return command;
}

/// What the bridge could write when it were somebody else's: the memory as it lies.
CommandLayout& layoutOf(SharedMemory& memory) {
    return *reinterpret_cast<CommandLayout*>(memory.data());
}

TEST(CommandMemory, BringsCommandsOverInOrder) {
    CommandReceiver receiver;
    CommandSender sender{receiver.descriptor()};
    for (std::uint64_t i = 0; i < 3; ++i) EXPECT_TRUE(sender.send(inch(i)));
    CommandRecord command;
    for (std::uint64_t i = 0; i < 3; ++i) {
        ASSERT_TRUE(receiver.next(command));
        EXPECT_EQ(command.request, i);
        EXPECT_EQ(view(command.axis), "X");
        EXPECT_EQ(command.distance, 0.5);
    }
    EXPECT_FALSE(receiver.next(command));
}

TEST(CommandMemory, TellsTheBridgeWhenItIsFull) {
    CommandReceiver receiver;
    CommandSender sender{receiver.descriptor()};
    for (std::uint64_t i = 0; i < CommandDepth; ++i) ASSERT_TRUE(sender.send(inch(i)));
    EXPECT_FALSE(sender.send(inch(0)));
    CommandRecord command;
    ASSERT_TRUE(receiver.next(command));
    EXPECT_TRUE(sender.send(inch(CommandDepth)));
}

TEST(CommandMemory, PassesOverRecordsThatAreOutOfRange) {
    CommandReceiver receiver;
    CommandSender sender{receiver.descriptor()};
    CommandRecord bad = inch(1);
    bad.order = static_cast<CommandOrder>(CommandOrders);
    EXPECT_TRUE(sender.send(bad));
    bad = inch(2);
    bad.distance = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(sender.send(bad));
    bad = inch(3);
    bad.velocity = -std::numeric_limits<double>::infinity();
    EXPECT_TRUE(sender.send(bad));
    bad = inch(4);
    bad.axis.fill('A');  // no end
    EXPECT_TRUE(sender.send(bad));
    bad = inch(5);
    bad.who = {'\x1b', '[', '2', 'J'};
    EXPECT_TRUE(sender.send(bad));
    bad = inch(6);
    bad.writer = 0;
    EXPECT_TRUE(sender.send(bad));
    EXPECT_TRUE(sender.send(inch(7)));
    CommandRecord command;
    ASSERT_TRUE(receiver.next(command));
    EXPECT_EQ(command.request, 7U);
    EXPECT_EQ(receiver.malformed(), 6U);
}

TEST(CommandMemory, SurvivesAnyBytesInIt) {
    CommandReceiver receiver;
    SharedMemory hostile = SharedMemory::attach(receiver.descriptor(), SharedMemory::Others::Write);
    CommandLayout& layout = layoutOf(hostile);
    std::uint64_t random = 88172645463325252U;
    const auto next = [&random] {
        random ^= random << 13U;
        random ^= random >> 7U;
        random ^= random << 17U;
        return random;
    };
    CommandRecord command;
    for (int round = 0; round < 2000; ++round) {
        for (auto& record : layout.records) {
            for (auto& word : record) word.store(next());
        }
        // Sometimes counts that are near, mostly any.
        const bool near = round % 3 == 0;
        layout.written.store(near ? layout.taken.load() + next() % CommandDepth : next());
        std::size_t taken = 0;
        while (receiver.next(command)) {
            EXPECT_TRUE(isWellFormed(command));
            ++taken;
        }
        EXPECT_LE(taken, CommandDepth);
        EXPECT_FALSE(receiver.next(command));
    }
    EXPECT_GT(receiver.malformed(), 1000U);
}

TEST(CommandMemory, WorksAgainAfterItWasFilledWithNonsense) {
    CommandReceiver receiver;
    {
        SharedMemory hostile =
            SharedMemory::attach(receiver.descriptor(), SharedMemory::Others::Write);
        std::memset(hostile.data(), 0xA5, hostile.size());
    }
    receiver.reset();
    CommandSender sender{receiver.descriptor()};
    EXPECT_EQ(receiver.published(), 0U);
    EXPECT_TRUE(sender.send(inch(4)));
    CommandRecord command;
    ASSERT_TRUE(receiver.next(command));
    EXPECT_EQ(command.request, 4U);
}

TEST(CommandMemory, ForgetsWhatABridgeThatEndedHasLeft) {
    CommandReceiver receiver;
    CommandSender sender{receiver.descriptor()};
    EXPECT_TRUE(sender.send(inch(1)));
    sender.published(9);
    receiver.reset();
    CommandRecord command;
    EXPECT_FALSE(receiver.next(command));
    EXPECT_EQ(receiver.published(), 0U);
}

TEST(CommandMemory, LosesNothingBetweenTwoThreads) {
    constexpr std::uint64_t count = 50'000;
    CommandReceiver receiver;
    std::thread sending{[descriptor = receiver.descriptor()] {
        CommandSender sender{descriptor};
        for (std::uint64_t i = 0; i < count;) {
            if (sender.send(inch(i))) ++i;
        }
    }};
    CommandRecord command;
    for (std::uint64_t i = 0; i < count;) {
        if (!receiver.next(command)) continue;
        EXPECT_EQ(command.request, i);
        ++i;
    }
    sending.join();
    EXPECT_EQ(receiver.malformed(), 0U);
}

}  // namespace
}  // namespace takt::bridge
