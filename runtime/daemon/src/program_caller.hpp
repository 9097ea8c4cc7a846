#pragma once

#include <memory>
#include <takt/core/clock_source.hpp>
#include <takt/core/time.hpp>

#include "program_watchdog.hpp"
#include "program_work.hpp"
#include "realtime_thread.hpp"

namespace takt::daemon {

enum class CallOutcome : std::uint8_t {
    CameBack,
    Late,       ///< still out, excused: the call goes on
    Abandoned,  ///< it had its time; whatever it does from now on, nobody looks
};

/// Makes the calls of one program.
class ProgramCaller {
public:
    virtual ~ProgramCaller() = default;
    /// rt. A call of an earlier cycle has not come back yet.
    [[nodiscard]] virtual bool underWay() const noexcept = 0;
    /// rt. Makes the next call, or goes on waiting for the one under way. Not after Abandoned.
    [[nodiscard]] virtual CallOutcome call(ProgramWork& work, core::CycleNumber cycle) noexcept = 0;
    /// After the last cycle. \return false when a call is still out: its work must then be left
    /// alone for good
    [[nodiscard]] virtual bool retire() noexcept = 0;
};

/// Calls in the thread of the cycle: in virtual time, where no call is ever late. A watchdog on the
/// wall clock ends the process when one does not come back.
class InlineCaller final : public ProgramCaller {
public:
    InlineCaller(ProgramWatchdog& watchdog, std::size_t program) noexcept
        : watchdog_{watchdog}, program_{program} {}

    [[nodiscard]] bool underWay() const noexcept override { return false; }
    [[nodiscard]] CallOutcome call(ProgramWork& work, core::CycleNumber cycle) noexcept override;
    [[nodiscard]] bool retire() noexcept override { return true; }

private:
    ProgramWatchdog& watchdog_;
    std::size_t program_;
};

/// How long a call may take.
struct CallBudget {
    core::Duration time{0};
    /// A call that was kept from the processor is excused: only processor time counts, up to a
    /// second. For computers that cannot keep time.
    bool processorTimeOnly{false};
};

/// Calls on a thread of the program's own, just below the cycle's priority: the cycle opens the
/// gate and goes on when the call has come back or its budget has ended. Two system calls in the
/// cycle.
class ThreadCaller final : public ProgramCaller {
public:
    ThreadCaller(const ThreadPlace& place, const CallBudget& budget, core::ClockSource& clock,
                 Notes& notes);
    ~ThreadCaller() override;
    ThreadCaller(const ThreadCaller&) = delete;
    ThreadCaller& operator=(const ThreadCaller&) = delete;

    [[nodiscard]] bool underWay() const noexcept override { return underWay_; }
    [[nodiscard]] CallOutcome call(ProgramWork& work, core::CycleNumber cycle) noexcept override;
    [[nodiscard]] bool retire() noexcept override;

private:
    struct Gate;  ///< shared with the thread, which may outlive this object

    [[nodiscard]] bool excused() noexcept;
    void abandon() noexcept;
    [[nodiscard]] core::Duration processorTime() const noexcept;

    CallBudget budget_;
    core::ClockSource& clock_;
    std::shared_ptr<Gate> gate_;
    std::unique_ptr<RealtimeThread> thread_;
    bool underWay_{false};
    bool abandoned_{false};
    bool missed_{false};  ///< this call has outlasted its budget
    core::HostTime opened_{};
    core::Duration usedAtMiss_{0};  ///< processor time of the thread at that moment
};

}  // namespace takt::daemon
