#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <takt/daemon/run_options.hpp>
#include <takt/scheduler/overrun_guard.hpp>
#include <vector>

#include "assembly.hpp"
#include "bridge_door.hpp"
#include "bus.hpp"
#include "console.hpp"
#include "control_server.hpp"
#include "loading.hpp"
#include "machine_control.hpp"
#include "machine_cycle.hpp"
#include "network_summary.hpp"
#include "pace.hpp"
#include "planning_thread.hpp"
#include "program_watchdog.hpp"
#include "realtime_thread.hpp"
#include "route_office.hpp"
#include "run_notice.hpp"
#include "run_reporter.hpp"
#include "service_notifier.hpp"
#include "stop_request.hpp"

namespace takt::daemon {

/// The life of one run, from the first frame to INIT:
///
///     BringUp → GoingOp → Operating → PoweringOff → LeavingOp → Over
///
/// The cycle itself is in MachineCycle; after each cycle this class looks at what has become of it
/// and gives the next orders, still in the cycle's thread and by its rules. What people should know
/// leaves as notices. In virtual time all of it happens in the calling thread; on a real network
/// the cycle has a thread of its own and the calling one keeps house: prints, writes files.
class MachineRun {
public:
    /// All must outlive the object. \throw std::runtime_error when the network, the control socket
    /// or a file of commands cannot be had
    MachineRun(const RunOptions& options, LoadedMachine& machine, Recorders& recorders,
               Console& console);

    /// \return the exit code
    int execute();
    /// Cycles and their length, for the plot.
    [[nodiscard]] std::string summary() const;

private:
    using Phase = RunPhase;

    [[nodiscard]] bool onMachine() const noexcept { return !options_.interface.empty(); }
    bool bringUp();
    void begin();
    void runInline();
    void runOnThreads();
    void keepHouse(bool cycleRests);
    void conclude();
    [[nodiscard]] NetworkReport networkReport();
    void planPaths();
    [[noreturn]] void leaveHangingProgram(std::size_t program, core::CycleNumber cycle);

    // rt, after each cycle.
    void oneCycle() noexcept;
    void supervise() noexcept;
    [[nodiscard]] DiagnosisEntry diagnosis() const noexcept;
    void doJobs() noexcept;
    void superviseOverruns(const scheduler::Beat& beat) noexcept;
    void superviseGoingOp() noexcept;
    void superviseOperating() noexcept;
    void supervisePoweringOff() noexcept;
    void superviseLeavingOp() noexcept;
    void enter(Phase phase) noexcept;
    void fail(ExitCode code, RunNotice::Kind kind, std::size_t index = 0) noexcept;
    void send(const RunNotice& notice) noexcept;
    void note(RunNotice::Kind kind, std::size_t index = 0, std::uint64_t number = 0) noexcept;
    void noteEndedPrograms() noexcept;
    void noteMachineStop() noexcept;
    void endOperation() noexcept;
    void quickStopAll() noexcept;
    [[nodiscard]] core::Duration inPhase() const noexcept;
    [[nodiscard]] int exitCode() const;

    const RunOptions& options_;
    const config::MachineConfig& machine_;
    Recorders& recorders_;
    Console& console_;
    StopRequest stop_;
    Axes& axes_;
    Groups& groups_;
    std::vector<ProgramHost>& programs_;
    std::vector<bool> endNoted_;      ///< programs whose end has been noted
    std::vector<bool> overdueNoted_;  ///< axes that outlasted the present machine stop
    Bus bus_;
    scheduler::DcLock dcLock_;
    scheduler::Grid grid_;
    scheduler::OverrunGuard overruns_;
    ProgramStock stock_;
    std::unique_ptr<BridgeDoor> bridge_;  ///< null: the machine file asks for none
    MachineControl control_;
    ControlServer server_;
    MachineCycle cycle_;
    Pace pace_;
    CycleOrders orders_;
    RunNotices notices_;
    std::uint64_t noted_{0};              ///< notices sent
    std::atomic<std::uint64_t> told_{0};  ///< … and put into words, or held back
    std::vector<RunNotice> heldBack_;     ///< until what they speak of rests
    RunReporter reporter_;
    ServiceNotifier service_;
    Phase phase_{Phase::BringUp};
    core::CycleNumber phaseBegan_{0};
    core::CycleNumber now_{0};
    ExitCode code_{ExitCode::Good};
    bool quickStopped_{false};
    bool stopTimedOut_{false};
    bool stopNoted_{false};  ///< the present machine stop has been noted
    RouteOffice routes_;
    std::unique_ptr<PlanningThread> planning_;  ///< of paths; on a machine with groups
    std::unique_ptr<PlanningThread> routing_;   ///< of ways around keep-outs, likewise
    std::atomic<bool> over_{false};
};

}  // namespace takt::daemon
