#include "program_caller.hpp"

#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <ctime>
#include <takt/core/cycle_guard.hpp>

namespace takt::daemon {

namespace {

constexpr std::int64_t NanosPerSecond = 1'000'000'000;
/// So long even a call that is kept from the processor may take.
constexpr core::Duration LongestExcuse = std::chrono::seconds{1};

// The kernel's own interface: its wait takes an absolute time on the monotonic clock.
static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t));

void wake(std::atomic<std::uint32_t>& word) noexcept {
    syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

/// \param deadline null: none. \return false at the deadline
bool wait(std::atomic<std::uint32_t>& word, std::uint32_t seen, const timespec* deadline) noexcept {
    return syscall(SYS_futex, &word, FUTEX_WAIT_BITSET_PRIVATE, seen, deadline, nullptr,
                   FUTEX_BITSET_MATCH_ANY) == 0 ||
           errno != ETIMEDOUT;
}

}  // namespace

CallOutcome InlineCaller::call(ProgramWork& work, core::CycleNumber cycle) noexcept {
    watchdog_.begin(program_, cycle);
    work.call();
    watchdog_.end();
    return CallOutcome::CameBack;
}

struct ThreadCaller::Gate {
    enum Turn : std::uint32_t { OfCycle, OfProgram, Over };

    std::atomic<std::uint32_t> turn{OfCycle};
    std::atomic<pid_t> thread{0};
    ProgramWork* work{nullptr};  ///< belongs to whose turn it is

    void open() noexcept {
        turn.store(OfProgram, std::memory_order_release);
        wake(turn);
    }
    [[nodiscard]] bool awaitReturn(core::HostTime deadline) noexcept {
        const std::int64_t ns = deadline.time_since_epoch().count();
        const timespec until{ns / NanosPerSecond, ns % NanosPerSecond};
        while (turn.load(std::memory_order_acquire) == OfProgram) {
            if (!wait(turn, OfProgram, &until))
                return turn.load(std::memory_order_acquire) == OfCycle;
        }
        return true;
    }
    void serve() noexcept {
        thread.store(static_cast<pid_t>(syscall(SYS_gettid)), std::memory_order_release);
        for (;;) {
            std::uint32_t whose = turn.load(std::memory_order_acquire);
            while (whose == OfCycle) {
                wait(turn, OfCycle, nullptr);
                whose = turn.load(std::memory_order_acquire);
            }
            if (whose == Over) return;
            {
                const core::CycleGuard guard;
                work->call();
            }
            turn.store(OfCycle, std::memory_order_release);
            wake(turn);
        }
    }
    void end() noexcept {
        turn.store(Over, std::memory_order_release);
        wake(turn);
    }
};

ThreadCaller::ThreadCaller(const ThreadPlace& place, const CallBudget& budget,
                           core::ClockSource& clock, Notes& notes)
    : budget_{budget},
      clock_{clock},
      gate_{std::make_shared<Gate>()},
      thread_{std::make_unique<RealtimeThread>(
          place, [gate = gate_] { gate->serve(); }, notes)} {
    while (gate_->thread.load(std::memory_order_acquire) == 0) sched_yield();
}

ThreadCaller::~ThreadCaller() {
    static_cast<void>(retire());
}

bool ThreadCaller::retire() noexcept {
    if (abandoned_) return false;
    // A call that was excused so far gets its second here.
    if (underWay_ && !gate_->awaitReturn(clock_.now() + LongestExcuse)) {
        abandon();
        return false;
    }
    underWay_ = false;
    gate_->end();
    return true;
}

CallOutcome ThreadCaller::call(ProgramWork& work, core::CycleNumber /*cycle*/) noexcept {
    const core::HostTime now = clock_.now();
    if (!underWay_) {
        underWay_ = true;
        missed_ = false;
        opened_ = now;
        gate_->work = &work;
        gate_->open();
    }
    {
        const core::CycleGuardPause theGateIsAllowed;
        const core::HostTime deadline = now + budget_.time;
        // Who wakes up from waiting this late was kept from the processor himself, and so was the
        // program: it gets its time again, once.
        if (gate_->awaitReturn(deadline) || (clock_.now() - deadline > budget_.time &&
                                             gate_->awaitReturn(clock_.now() + budget_.time))) {
            underWay_ = false;
            return CallOutcome::CameBack;
        }
    }
    if (budget_.processorTimeOnly && excused()) return CallOutcome::Late;
    abandon();
    return CallOutcome::Abandoned;
}

bool ThreadCaller::excused() noexcept {
    if (clock_.now() - opened_ > LongestExcuse) return false;
    const core::Duration used = processorTime();
    if (!missed_) usedAtMiss_ = used;
    missed_ = true;
    return used - usedAtMiss_ < budget_.time;
}

core::Duration ThreadCaller::processorTime() const noexcept {
    // clock_getcpuclockid(3) for a thread: the kernel's encoding of a per-thread clock.
    const auto id = static_cast<clockid_t>(
        (~static_cast<unsigned>(gate_->thread.load(std::memory_order_relaxed)) << 3U) | 6U);
    timespec time{};
    clock_gettime(id, &time);
    return core::Duration{time.tv_sec * NanosPerSecond + time.tv_nsec};
}

void ThreadCaller::abandon() noexcept {
    abandoned_ = true;
    thread_->letGo();
    // Without its priority it cannot keep the rest of the computer from working.
    const sched_param none{};
    sched_setscheduler(gate_->thread.load(std::memory_order_relaxed), SCHED_IDLE, &none);
}

}  // namespace takt::daemon
