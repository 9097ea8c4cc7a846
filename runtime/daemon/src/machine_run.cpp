#include "machine_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <takt/fieldbus/bus_timing.hpp>
#include <thread>
#include <utility>

#include "run_limits.hpp"

namespace takt::daemon {

namespace {

using namespace std::chrono_literals;

constexpr std::size_t NoticeRoom = 256;
constexpr auto HouseInterval = 20ms;

double seconds(core::Duration duration) {
    return std::chrono::duration<double>{duration}.count();
}

std::unique_ptr<BusEnd> endFor(const RunOptions& options, const config::MachineConfig& machine) {
    if (options.interface.empty()) return simulatedEnd(machine);
    // One more than the cycle needs: what answers late must not keep a reply out.
    return interfaceEnd(options.interface, fieldbus::computeTiming(machine.network).frames + 1);
}

/// A run with --fast leaves every subscriber behind, so it has no bridge.
std::unique_ptr<BridgeDoor> bridgeFor(const RunOptions& options,
                                      const config::MachineConfig& machine) {
    if (options.fast || !machine.bridge.dds.enabled) return nullptr;
    return std::make_unique<BridgeDoor>(machine);
}

/// A real computer sends a little later or earlier each time; a lock that waits for the precision
/// of a simulated one would never be found. SYNC0 comes a quarter of the cycle after the frame, at
/// least.
scheduler::DcLockParams lockFor(const RunOptions& options, const config::MachineConfig& machine) {
    scheduler::DcLockParams params = machine.scheduler.dcLock;
    if (options.interface.empty()) return params;
    constexpr int windowPart = 100;
    constexpr std::uint32_t fewest = 25;
    params.window = std::max(params.window, machine.network.cycle / windowPart);
    const auto inTenth = static_cast<std::uint32_t>(100ms / machine.network.cycle);
    params.windowCycles = std::clamp(inTenth, fewest, params.windowCycles);
    return params;
}

/// Missed cycles that the motion makes up for: fewer than stop the machine, and no more than frames
/// may be lost in a row, because for the drives it is the same.
std::uint32_t bridgeable(const config::MachineConfig& machine) {
    const std::uint32_t stopAfter = machine.scheduler.overruns.stopAfter;
    return std::min(stopAfter > 0 ? stopAfter - 1 : 0, machine.network.lostLimit);
}

/// The share of the cycle that each program gets: half of it for all together, unless one was given
/// more.
double budgetScale(const std::vector<ProgramHost>& programs) {
    constexpr double half = 0.5;
    double sum = 0;
    double largest = half;
    for (const ProgramHost& program : programs) {
        sum += program.params().budgetShare;
        largest = std::max(largest, program.params().budgetShare);
    }
    return sum > largest ? largest / sum : 1.0;
}

}  // namespace

MachineRun::MachineRun(const RunOptions& options, LoadedMachine& machine, Recorders& recorders,
                       Console& console)
    : options_{options},
      machine_{machine.config},
      recorders_{recorders},
      console_{console},
      axes_{machine.axes},
      groups_{machine.groups},
      programs_{machine.programs},
      endNoted_(programs_.size(), false),
      overdueNoted_(axes_.size(), false),
      bus_{machine_, endFor(options, machine_), recorders.capture()},
      dcLock_{lockFor(options, machine_), machine_.network.cycle},
      grid_{core::HostTime{}, machine_.network.cycle},
      overruns_{machine_.scheduler.overruns},
      stock_{programs_, machine.factories, machine_},
      bridge_{bridgeFor(options, machine_)},
      control_{{machine_, bus_.master(), axes_, groups_, programs_, stock_,
                bridge_ ? &bridge_->status() : nullptr},
               machine.commands,
               !options.recordCommands.empty()},
      server_{{machine_, stock_, control_, bridge_.get()}, options.socket, options.recordCommands},
      cycle_{{bus_.master(),
              {axes_, groups_},
              programs_,
              grid_,
              dcLock_,
              recorders_,
              control_,
              bus_.clock(),
              machine_.network.cycle}},
      pace_{!options.fast && options.interface.empty()},
      notices_{NoticeRoom},
      reporter_{machine_, programs_, bus_.master(), control_.names(), console},
      routes_{machine_, axes_, programs_} {
    attachAxes(machine_, bus_.master(), axes_);
    for (const TakenCommand& taken : machine.commands) {
        if (taken.command.order != Order::ProgramReset) continue;
        for (const std::string& problem : stock_.prepare(taken.command.target))
            throw std::runtime_error{fmt::format("{}: {}", options.commands.string(), problem)};
    }
}

int MachineRun::execute() {
    if (!bringUp()) return exitCode();
    if (onMachine()) {
        runOnThreads();
    } else {
        runInline();
    }
    for (ProgramHost& program : programs_) program.stop();
    conclude();
    return exitCode();
}

bool MachineRun::bringUp() {
    console_.line(fmt::format("{}: {} devices, {} axes, cycle {} us, {}{}", machine_.name,
                              machine_.network.slaves.size(), axes_.size(),
                              machine_.network.cycle.count() / 1000,
                              onMachine() ? "interface " : "simulated", options_.interface));
    if (options_.socket.empty() && server_.path().filename() != machine_.name + ".sock") {
        console_.line(
            fmt::format("control socket {}, since another takt runs a machine of this name",
                        server_.path().string()));
    }
    const auto problems = bus_.master().bringUp(
        [this](std::string_view text) {
            recorders_.drain();
            console_.progress(text);
        },
        [this] { return stop_.count() == 0; });
    recorders_.drain();
    for (const auto& problem : problems) {
        console_.error(fmt::format(
            "{}: {}", problem.origin.empty() ? machine_.file : problem.origin, problem.text));
    }
    if (!problems.empty()) code_ = ExitCode::CouldNotRun;
    return problems.empty();
}

/// Directly before the first cycle.
void MachineRun::begin() {
    const core::HostTime soon = bus_.clock().now() + machine_.network.cycle;
    grid_ = scheduler::Grid{bus_.master().firstSend(soon), machine_.network.cycle,
                            bridgeable(machine_)};
    bus_.master().prepare();
    bus_.master().requestOp();
    enter(Phase::GoingOp);
}

void MachineRun::runInline() {
    ProgramWatchdog watchdog{options_.programWatchdog,
                             [this](std::size_t program, core::CycleNumber cycle) {
                                 leaveHangingProgram(program, cycle);
                             }};
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        programs_[i].useCaller(std::make_unique<InlineCaller>(watchdog, i));
    }
    const core::HostTime began = bus_.clock().now();
    begin();
    while (phase_ != Phase::Over) {
        oneCycle();
        keepHouse(true);
        pace_.wait(bus_.clock().now() - began);
    }
}

void MachineRun::leaveHangingProgram(std::size_t program, core::CycleNumber cycle) {
    console_.error(fmt::format(
        "program '{}' did not come back from its call in cycle {} within {:g} s and was abandoned",
        programs_[program].name(), cycle, seconds(options_.programWatchdog)));
    // The cycle's thread is inside the program: the records are nobody else's now.
    for (const std::string& problem : recorders_.finish(machine_.name, summary()))
        console_.error(problem);
    std::fflush(nullptr);
    std::_Exit(static_cast<int>(ExitCode::ProgramAbandoned));
}

void MachineRun::runOnThreads() {
    const scheduler::SchedulerParams& params = machine_.scheduler;
    const bool lenient = params.overruns.policy == scheduler::OverrunPolicy::Count;
    const double scale = budgetScale(programs_);
    Notes notes;
    for (ProgramHost& program : programs_) {
        const double share = program.params().budgetShare * scale;
        const auto budget =
            static_cast<std::int64_t>(share * static_cast<double>(machine_.network.cycle.count()));
        program.useCaller(std::make_unique<ThreadCaller>(
            ThreadPlace{"takt-" + program.name(), std::max(params.priority - 1, 0), params.cpu},
            CallBudget{core::Duration{budget}, lenient}, bus_.clock(), notes));
    }
    if (!groups_.empty()) {
        // Below the programs, so that a long plan keeps nobody from his cycle.
        planning_ = std::make_unique<PlanningThread>(
            ThreadPlace{"takt-plan", std::max(params.priority - 2, 0), -1}, [this] { planPaths(); },
            notes);
        // No motion waits for a way: it may take as long as other processes let it.
        routing_ = std::make_unique<PlanningThread>(
            ThreadPlace{"takt-route", 0, -1}, [this] { routes_.work(); }, notes);
    }
    std::atomic<bool> go{false};
    RealtimeThread thread{{"takt-cycle", params.priority, params.cpu},
                          [this, &go] {
                              go.wait(false);
                              begin();
                              while (phase_ != Phase::Over) oneCycle();
                              over_.store(true, std::memory_order_release);
                          },
                          notes};
    lockMemory(notes);
    dropCapabilities();
    for (const std::string& line : notes.lines()) console_.line(line);
    go.store(true);
    go.notify_one();
    while (!over_.load(std::memory_order_acquire)) {
        keepHouse(false);
        std::this_thread::sleep_for(HouseInterval);
    }
    thread.join();
    planning_.reset();
    routing_.reset();
    keepHouse(true);
}

/// Files, messages, progress. The words for the state of the network are found when no cycle
/// changes it.
void MachineRun::keepHouse(bool cycleRests) {
    RunNotice notice;
    std::uint64_t taken = 0;
    for (; notices_.pop(notice); ++taken) heldBack_.push_back(notice);
    std::erase_if(heldBack_, [this, cycleRests](const RunNotice& held) {
        const bool ofNetwork =
            held.kind == RunNotice::Kind::NetworkFailed || held.kind == RunNotice::Kind::OpTimedOut;
        if (ofNetwork && !cycleRests) return false;
        reporter_.tell(held);
        if (held.kind == RunNotice::Kind::ReachedOp)
            service_.ready(machine_.name + " in operation");
        return true;
    });
    told_.fetch_add(taken, std::memory_order_release);
    recorders_.drain();
    reporter_.progress(control_.board());
    const RunEntry run = control_.board().run.read();
    if (run.phase > RunPhase::Operating) service_.stopping();
    service_.alive(run.cycle);
}

void MachineRun::conclude() {
    if (!server_.finish()) {
        console_.error(
            fmt::format("{}: not complete; is the disk full?", options_.recordCommands.string()));
        if (code_ == ExitCode::Good) code_ = ExitCode::CouldNotRun;
    }
    if (reporter_.tellErrors({axes_, groups_}) && code_ == ExitCode::Good)
        code_ = ExitCode::MachineFault;
    const double simulated = static_cast<double>(now_) * seconds(machine_.network.cycle);
    const double wall = seconds(pace_.elapsed());
    const NetworkReport network = networkReport();
    console_.line(fmt::format("{:.3f} s in {} cycles, {:.1f} times real time; {}", simulated, now_,
                              wall > 0 ? simulated / wall : 0.0, frameSummary(network)));
    if (!onMachine()) return;
    for (const std::string& line : timeTable(network)) console_.line(line);
    for (const axis::Group& group : groups_) {
        if (group.status().latePlans == 0) continue;
        console_.line(fmt::format("warning: group {}: {} plans came late; more latency helps",
                                  group.name(), group.status().latePlans));
    }
    const bool anyTrouble =
        std::any_of(network.devices.begin(), network.devices.end(), [](const DeviceReport& device) {
            return !device.workingCounter.empty() || device.emergencies > 0;
        });
    if (!anyTrouble) return;
    for (const std::string& line : deviceTable(network)) console_.line(line);
}

/// \pre no cycle runs
NetworkReport MachineRun::networkReport() {
    std::vector<DeviceEntry> devices;
    for (std::size_t i = 0; i < machine_.network.slaves.size(); ++i)
        devices.push_back(entryOf(bus_.master(), i));
    return summarize(machine_, diagnosis(), devices);
}

std::string MachineRun::summary() const {
    return fmt::format("{} cycles of {} us on {}", control_.board().run.read().cycle + 1,
                       machine_.network.cycle.count() / 1000,
                       onMachine() ? options_.interface : "the simulated machine");
}

int MachineRun::exitCode() const {
    if (code_ != ExitCode::StopTimeout && stop_.count() > 0) return 128 + stop_.signal();
    return static_cast<int>(code_);
}

}  // namespace takt::daemon
