#include "program_caller.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <takt/core/monotonic_clock.hpp>

namespace takt::daemon {
namespace {

using namespace std::chrono_literals;

constexpr core::Duration Plenty = 30s;  // where a call is expected back
constexpr core::Duration Little = 2ms;  // where it is not

/// Does in each call what the test tells it.
struct Script {
    std::atomic<bool> block{false};  ///< wait, without using the processor
    std::atomic<bool> spin{false};   ///< use the processor
    std::atomic<int> calls{0};
};

class Scripted : public program::Program {
public:
    explicit Scripted(std::shared_ptr<Script> script) : script_{std::move(script)} {}
    program::ProgramState cycle(program::Machine& /*machine*/) override {
        ++script_->calls;
        script_->block.wait(true);
        while (script_->spin.load(std::memory_order_relaxed)) {
        }
        return program::ProgramState::Running;
    }

private:
    std::shared_ptr<Script> script_;  // outlives the test where a call does
};

class OnAThread : public testing::Test {
protected:
    OnAThread() {
        program::ProgramPtr program{
            new Scripted{script_},
            program::ProgramDeleter{nullptr, [](program::Program* p) { delete p; }}};
        work_ =
            std::make_unique<ProgramWork>(std::move(program), 0, RouteDesks{}, std::uint16_t{1});
        work_->setMachine(
            std::make_unique<program::Machine>(std::vector<program::Machine::NamedAxis>{},
                                               std::vector<program::Machine::NamedGroup>{}, 1ms));
    }
    std::unique_ptr<ThreadCaller> caller(core::Duration budget, bool lenient = false) {
        return std::make_unique<ThreadCaller>(ThreadPlace{"test", 0, -1},
                                              CallBudget{budget, lenient}, clock_, notes_);
    }

    core::MonotonicClock clock_;
    Notes notes_;
    std::shared_ptr<Script> script_{std::make_shared<Script>()};
    std::unique_ptr<ProgramWork> work_;
};

TEST_F(OnAThread, ACallWithinItsBudgetComesBack) {
    const auto thread = caller(Plenty);
    for (core::CycleNumber i = 0; i < 1000; ++i) {
        ASSERT_EQ(thread->call(*work_, i), CallOutcome::CameBack);
        ASSERT_EQ(script_->calls, static_cast<int>(i) + 1);
        ASSERT_FALSE(thread->underWay());
    }
    EXPECT_TRUE(thread->retire());
}

TEST_F(OnAThread, ACallThatOutlastsItsBudgetIsAbandoned) {
    script_->block = true;
    const auto thread = caller(Little);
    EXPECT_EQ(thread->call(*work_, 0), CallOutcome::Abandoned);
    EXPECT_FALSE(thread->retire()) << "its work must be left alone";
    // Let it end, so that nothing of this test is in use any more.
    script_->block = false;
    script_->block.notify_all();
    static_cast<void>(work_.release());
}

TEST_F(OnAThread, ACallThatIsKeptFromTheProcessorIsExcusedWhereThatIsAllowed) {
    script_->block = true;
    const auto thread = caller(Little, true);
    EXPECT_EQ(thread->call(*work_, 0), CallOutcome::Late);
    EXPECT_TRUE(thread->underWay());
    script_->block = false;
    script_->block.notify_all();
    CallOutcome outcome = CallOutcome::Late;
    for (core::CycleNumber i = 1; outcome == CallOutcome::Late && i < 400; ++i)
        outcome = thread->call(*work_, i);
    EXPECT_EQ(outcome, CallOutcome::CameBack);
    EXPECT_EQ(script_->calls, 1) << "the late call is the same one";
}

/// Seems to have stood still since it was looked at last, and lets something happen meanwhile.
class StallingClock : public core::ClockSource {
public:
    explicit StallingClock(std::function<void()> meanwhile) : meanwhile_{std::move(meanwhile)} {}
    [[nodiscard]] core::HostTime now() const noexcept override {
        if (looks_++ == 1) meanwhile_();
        return clock_.now() + (looks_ > 1 ? 30s : 0s);
    }
    void sleepUntil(core::HostTime wake) noexcept override { clock_.sleepUntil(wake); }

private:
    core::MonotonicClock clock_;
    std::function<void()> meanwhile_;
    mutable int looks_{0};
};

TEST_F(OnAThread, ACallGetsItsBudgetAgainWhenTheWholeComputerStoodStill) {
    script_->block = true;
    StallingClock clock{[this] {
        script_->block = false;
        script_->block.notify_all();
    }};
    ThreadCaller thread{ThreadPlace{"test", 0, -1}, CallBudget{Little, false}, clock, notes_};
    EXPECT_EQ(thread.call(*work_, 0), CallOutcome::CameBack);
    EXPECT_TRUE(thread.retire());
}

TEST_F(OnAThread, ACallThatUsesUpTheProcessorIsNotExcused) {
    script_->spin = true;
    const auto thread = caller(Little, true);
    CallOutcome outcome = CallOutcome::Late;
    for (core::CycleNumber i = 0; outcome == CallOutcome::Late && i < 2000; ++i)
        outcome = thread->call(*work_, i);
    EXPECT_EQ(outcome, CallOutcome::Abandoned);
    script_->spin = false;
    static_cast<void>(work_.release());
}

TEST(ProgramWatchdog, NamesTheCallThatDoesNotComeBack) {
    std::promise<std::pair<std::size_t, core::CycleNumber>> told;
    ProgramWatchdog watchdog{20ms, [&told](std::size_t program, core::CycleNumber cycle) {
                                 told.set_value({program, cycle});
                             }};
    watchdog.begin(2, 4711);
    EXPECT_EQ(told.get_future().get(), (std::pair<std::size_t, core::CycleNumber>{2, 4711}));
}

}  // namespace
}  // namespace takt::daemon
