#pragma once

#include <string>
#include <vector>

#include <takt/daemon/run_options.hpp>

#include "assembly.hpp"
#include "console.hpp"
#include "control_server.hpp"
#include "loading.hpp"
#include "machine_control.hpp"
#include "machine_cycle.hpp"
#include "pace.hpp"
#include "stop_request.hpp"

namespace takt::daemon {

/// The life of one run, from the first frame to INIT:
///
///     BringUp → GoingOp → Operating → PoweringOff → LeavingOp → Over
///
/// The cycle itself is in MachineCycle; between two cycles this class looks at what has become of it and
/// gives the next orders.
class MachineRun {
public:
    /// All must outlive the object. \throw std::runtime_error when the control socket or a file of commands
    /// cannot be had
    MachineRun(const RunOptions& options, LoadedMachine& machine, Recorders& recorders,
               Console& console);

    /// \return the exit code
    int execute();
    /// Cycles and their length, for the plot.
    [[nodiscard]] std::string summary() const;

private:
    using Phase = RunPhase;

    bool bringUp();
    void supervise();
    void superviseGoingOp();
    void superviseOperating();
    void supervisePoweringOff();
    void superviseLeavingOp();
    void enter(Phase phase);
    void fail(ExitCode code, const std::string& why);
    void reportEndedPrograms();
    void reportMachineStop();
    void quickStopAll();
    void showProgress();
    void conclude();
    [[nodiscard]] core::Duration inPhase() const;
    [[nodiscard]] int exitCode() const;

    const RunOptions& options_;
    const config::MachineConfig& machine_;
    Recorders& recorders_;
    Console& console_;
    StopRequest stop_;
    Axes& axes_;
    std::vector<ProgramHost>& programs_;
    std::vector<bool> reported_;  ///< programs whose end has been told
    SimulatedBus bus_;
    scheduler::DcLock dcLock_;
    scheduler::Grid grid_;
    MachineControl control_;
    ControlServer server_;
    MachineCycle cycle_;
    Pace pace_;
    CycleOrders orders_;
    Phase phase_{Phase::BringUp};
    core::CycleNumber phaseBegan_{0};
    core::CycleNumber now_{0};
    ExitCode code_{ExitCode::Good};
    bool quickStopped_{false};
    bool stopTimedOut_{false};
    bool stopReported_{false};  ///< the present machine stop has been told
};

}  // namespace takt::daemon
