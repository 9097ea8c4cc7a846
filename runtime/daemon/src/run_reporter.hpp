#pragma once

#include <span>
#include <string>
#include <takt/config/machine_config.hpp>
#include <takt/fieldbus/ethercat/master.hpp>
#include <vector>

#include "axes.hpp"
#include "console.hpp"
#include "event_text.hpp"
#include "program_host.hpp"
#include "run_notice.hpp"
#include "status_board.hpp"

namespace takt::daemon {

/// Says in words what a run has noted. Outside the cycle.
class RunReporter {
public:
    /// All must outlive the object.
    RunReporter(const config::MachineConfig& machine, std::span<const ProgramHost> programs,
                const fieldbus::ethercat::Master& master, const ControlNames& names,
                Console& console)
        : machine_{machine},
          programs_{programs},
          master_{master},
          names_{names},
          console_{console} {}

    /// \pre what the notice is about no longer changes
    void tell(const RunNotice& notice);
    /// One line that is written over, about once in a second of cycles.
    void progress(const StatusBoard& board);
    /// The reason of every axis and group that ended in ErrorStop. \return false when there was
    /// none
    bool tellErrors(const Movers& movers);

private:
    void tellProgram(const ProgramHost& program);
    void tellMachineStop(const StopRecord& stop);

    const config::MachineConfig& machine_;
    std::span<const ProgramHost> programs_;
    const fieldbus::ethercat::Master& master_;
    const ControlNames& names_;
    Console& console_;
    core::CycleNumber shownAt_{0};
};

}  // namespace takt::daemon
