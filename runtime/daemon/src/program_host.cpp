#include "program_host.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

namespace takt::daemon {

namespace {

ProgramPhase phaseAfter(CallAnswer answer) noexcept {
    switch (answer) {
        case CallAnswer::Running:
            return ProgramPhase::Running;
        case CallAnswer::Finished:
            return ProgramPhase::Finished;
        case CallAnswer::Failed:
            return ProgramPhase::Failed;
        case CallAnswer::Threw:
            return ProgramPhase::Threw;
    }
    return ProgramPhase::Failed;
}

RouteDesks desks(std::size_t count) {
    RouteDesks all(count);
    for (auto& desk : all) desk = std::make_shared<axis::RouteDesk>();
    return all;
}

template <typename Params>
std::string namesOf(const std::vector<Params>& all) {
    std::string names;
    for (const Params& one : all) names += (names.empty() ? "" : ", ") + one.name;
    return names.empty() ? "none" : names;
}

}  // namespace

ProgramHost::ProgramHost(program::ProgramParams params, program::ProgramPtr program,
                         std::size_t axisCount, std::size_t groupCount, std::uint16_t number)
    : params_{std::move(params)},
      routes_{desks(groupCount)},
      work_{std::make_unique<ProgramWork>(std::move(program), axisCount, routes_, number)},
      commanded_(axisCount, false),
      groupCommanded_(groupCount, false) {}

ProgramHost::ProgramHost(const ProgramHost& first, program::ProgramPtr program,
                         std::size_t axisCount, std::uint16_t number)
    : params_{first.params_},
      routes_{first.routes_},
      work_{std::make_unique<ProgramWork>(std::move(program), axisCount, routes_, number)},
      commanded_(axisCount, false),
      groupCommanded_(routes_.size(), false) {}

ProgramHost::~ProgramHost() {
    // A call that is still out works on it, until the process ends.
    if (caller_ && !caller_->retire()) static_cast<void>(work_.release());
}

std::vector<std::string> ProgramHost::start(const config::MachineConfig& machine) {
    std::vector<program::Machine::NamedAxis> axes;
    std::vector<program::Machine::NamedGroup> groups;
    for (const axis::AxisParams& params : machine.axes)
        axes.push_back({params.name, axis::AxisRef{work_->area(axes.size())}});
    for (const axis::GroupParams& params : machine.groups) {
        groups.push_back(
            {params.name, axis::GroupRef{work_->groupArea(groups.size())}, params.axes});
    }
    work_->setMachine(std::make_unique<program::Machine>(
        std::move(axes), std::move(groups), machine.network.cycle * params_.everyCycles));
    std::vector<std::string> problems;
    try {
        work_->program().start(work_->machine());
        work_->program().describe(inspector_);
    } catch (const std::exception& error) {
        problems.push_back(fmt::format("program '{}' threw in start: {}", name(), error.what()));
    } catch (...) {
        problems.push_back(fmt::format("program '{}' threw in start", name()));
    }
    for (const std::string& axis : work_->machine().unknownAxes())
        problems.push_back(unknown("axis", axis, namesOf(machine.axes)));
    for (const std::string& group : work_->machine().unknownGroups())
        problems.push_back(unknown("group", group, namesOf(machine.groups)));
    return problems;
}

std::string ProgramHost::unknown(std::string_view kind, std::string_view asked,
                                 std::string_view known) const {
    return fmt::format("program '{}' asks for {} '{}', which does not exist; allowed: {}", name(),
                       kind, asked, known);
}

void ProgramHost::cycle(core::CycleNumber cycle, const Movers& movers) noexcept {
    if (ended()) return;
    const bool turn = due(cycle);
    if (!caller_->underWay()) {
        if (held_ || !turn) return;
        open(movers);
        phase_ = ProgramPhase::Running;
    }
    switch (caller_->call(*work_, cycle)) {
        case CallOutcome::Late:
            return;
        case CallOutcome::Abandoned:
            end(ProgramPhase::Abandoned, cycle);
            return stopMovers(movers);
        case CallOutcome::CameBack:
            break;
    }
    const ProgramPhase phase = phaseAfter(work_->answer());
    if (phase != ProgramPhase::Running) end(phase, cycle);
    settle(movers);
}

/// Every n-th cycle; when that one was missed, the next that runs.
bool ProgramHost::due(core::CycleNumber cycle) noexcept {
    const core::CycleNumber every = params_.everyCycles;
    const core::CycleNumber last = std::exchange(lastCycle_, cycle);
    return cycle % every == 0 || (last != 0 && last / every != cycle / every);
}

void ProgramHost::open(const Movers& movers) noexcept {
    for (std::size_t i = 0; i < movers.axes.size(); ++i) movers.axes[i].openPort(work_->area(i));
    for (std::size_t i = 0; i < movers.groups.size(); ++i)
        movers.groups[i].openPort(work_->groupArea(i));
}

void ProgramHost::settle(const Movers& movers) noexcept {
    // What a call brings that was still out when its program was stopped comes too late.
    const bool commandsCount =
        !held_ && (phase_ == ProgramPhase::Running || phase_ == ProgramPhase::Finished);
    // Groups first: what a group has begun to move answers single-axis commands itself.
    for (std::size_t i = 0; i < movers.groups.size(); ++i) {
        axis::GroupPort& area = work_->groupArea(i);
        if (!area.commands().empty()) groupCommanded_[i] = true;
        if (commandsCount) movers.groups[i].takeCommands(area);
    }
    for (std::size_t i = 0; i < movers.axes.size(); ++i) {
        axis::AxisPort& area = work_->area(i);
        if (!area.commands().empty()) commanded_[i] = true;
        if (commandsCount) movers.axes[i].takeCommands(area);
    }
    if (!commandsCount) stopMovers(movers);
}

void ProgramHost::stopMovers(const Movers& movers) noexcept {
    for (std::size_t i = 0; i < movers.groups.size(); ++i) {
        if (groupCommanded_[i]) movers.groups[i].stopByProgramLoss();
    }
    for (std::size_t i = 0; i < movers.axes.size(); ++i) {
        if (commanded_[i]) movers.axes[i].stopByProgramLoss();
    }
}

void ProgramHost::hold(const Movers& movers) noexcept {
    if (ended() || held_) return;
    held_ = true;
    stopMovers(movers);
}

void ProgramHost::exchange(ProgramHost& fresh, const Movers& movers) noexcept {
    stopMovers(movers);
    std::swap(work_, fresh.work_);
    std::swap(inspector_, fresh.inspector_);
    std::swap(commanded_, fresh.commanded_);
    std::swap(groupCommanded_, fresh.groupCommanded_);
    std::swap(instance_, fresh.instance_);
    phase_ = ProgramPhase::Waiting;
    held_ = true;
    endCycle_ = 0;
}

void ProgramHost::end(ProgramPhase phase, core::CycleNumber cycle) noexcept {
    phase_ = phase;
    endCycle_ = cycle;
}

void ProgramHost::stop() {
    if (caller_ && !caller_->retire()) return;
    try {
        work_->program().stop();
    } catch (...) {
        // The machine is already safe; what a program throws in its farewell changes nothing.
        return;
    }
}

std::string_view ProgramHost::failure() const noexcept {
    return phase_ == ProgramPhase::Abandoned ? std::string_view{} : work_->failure();
}

std::string ProgramHost::watches() const {
    if (phase_ == ProgramPhase::Abandoned) return {};  // it may be writing them
    std::string text;
    for (const program::Watch& watch : inspector_.watches()) {
        if (watch.pin) continue;  // many, and for looking at while it runs
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", watch.name, watch.text());
    }
    return text;
}

}  // namespace takt::daemon
