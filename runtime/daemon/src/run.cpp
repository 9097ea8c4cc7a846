#include <fmt/format.h>

#include <stdexcept>
#include <takt/daemon/run.hpp>
#include <utility>

#include "loading.hpp"
#include "machine_run.hpp"

namespace takt::daemon {

int run(const RunOptions& options, std::vector<LinkedProgram> linked) {
    Console console{options.quiet};
    auto machine = loadMachine(options, std::move(linked), console);
    if (!machine) return static_cast<int>(ExitCode::Refused);
    try {
        Recorders recorders{options, machine->config};
        MachineRun machineRun{options, *machine, recorders, console};
        const int code = machineRun.execute();
        const auto problems = recorders.finish(machine->config.name, machineRun.summary());
        for (const std::string& problem : problems) console.error(problem);
        if (const record::PcapngWriter* capture = recorders.capture()) {
            console.line(
                fmt::format("capture: {} frames, each sent and returned", capture->packets()));
        }
        if (!options.plot.empty()) console.line(fmt::format("plot: {}", options.plot.string()));
        if (!options.topView.empty())
            console.line(fmt::format("top view: {}", options.topView.string()));
        return code == 0 && !problems.empty() ? static_cast<int>(ExitCode::CouldNotRun) : code;
    } catch (const std::runtime_error& error) {
        console.error(error.what());
        return static_cast<int>(ExitCode::CouldNotRun);
    }
}

}  // namespace takt::daemon
