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

}  // namespace

ProgramHost::ProgramHost(program::ProgramParams params, program::ProgramPtr program,
                         std::size_t axisCount, std::uint16_t number)
    : params_{std::move(params)},
      work_{std::make_unique<ProgramWork>(std::move(program), axisCount, number)},
      commanded_(axisCount, false) {}

ProgramHost::~ProgramHost() {
    // A call that is still out works on it, until the process ends.
    if (caller_ && !caller_->retire()) static_cast<void>(work_.release());
}

std::vector<std::string> ProgramHost::start(const Axes& axes, core::Duration cycle) {
    std::vector<program::Machine::NamedAxis> named;
    std::string known;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        named.push_back({axes[i].name(), axis::AxisRef{work_->area(i)}});
        known += (i == 0 ? "" : ", ") + axes[i].name();
    }
    work_->setMachine(
        std::make_unique<program::Machine>(std::move(named), cycle * params_.everyCycles));
    std::vector<std::string> problems;
    try {
        work_->program().start(work_->machine());
        work_->program().describe(inspector_);
    } catch (const std::exception& error) {
        problems.push_back(fmt::format("program '{}' threw in start: {}", name(), error.what()));
    } catch (...) {
        problems.push_back(fmt::format("program '{}' threw in start", name()));
    }
    for (const std::string& axis : work_->machine().unknownAxes()) {
        problems.push_back(
            fmt::format("program '{}' asks for axis '{}', which does not exist; allowed: {}",
                        name(), axis, known));
    }
    return problems;
}

void ProgramHost::cycle(core::CycleNumber cycle, Axes& axes) noexcept {
    if (ended()) return;
    const bool turn = due(cycle);
    if (!caller_->underWay()) {
        if (held_ || !turn) return;
        open(axes);
        phase_ = ProgramPhase::Running;
    }
    switch (caller_->call(*work_, cycle)) {
        case CallOutcome::Late:
            return;
        case CallOutcome::Abandoned:
            end(ProgramPhase::Abandoned, cycle);
            return stopAxes(axes);
        case CallOutcome::CameBack:
            break;
    }
    const ProgramPhase phase = phaseAfter(work_->answer());
    if (phase != ProgramPhase::Running) end(phase, cycle);
    settle(axes);
}

/// Every n-th cycle; when that one was missed, the next that runs.
bool ProgramHost::due(core::CycleNumber cycle) noexcept {
    const core::CycleNumber every = params_.everyCycles;
    const core::CycleNumber last = std::exchange(lastCycle_, cycle);
    return cycle % every == 0 || (last != 0 && last / every != cycle / every);
}

void ProgramHost::open(Axes& axes) noexcept {
    for (std::size_t i = 0; i < axes.size(); ++i) axes[i].openPort(work_->area(i));
}

void ProgramHost::settle(Axes& axes) noexcept {
    // What a call brings that was still out when its program was stopped comes too late.
    const bool commandsCount =
        !held_ && (phase_ == ProgramPhase::Running || phase_ == ProgramPhase::Finished);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        axis::AxisPort& area = work_->area(i);
        if (!area.commands().empty()) commanded_[i] = true;
        if (commandsCount) axes[i].takeCommands(area);
    }
    if (!commandsCount) stopAxes(axes);
}

void ProgramHost::stopAxes(Axes& axes) noexcept {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (commanded_[i]) axes[i].stopByProgramLoss();
    }
}

void ProgramHost::hold(Axes& axes) noexcept {
    if (ended() || held_) return;
    held_ = true;
    stopAxes(axes);
}

void ProgramHost::exchange(ProgramHost& fresh, Axes& axes) noexcept {
    stopAxes(axes);
    std::swap(work_, fresh.work_);
    std::swap(inspector_, fresh.inspector_);
    std::swap(commanded_, fresh.commanded_);
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
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", watch.name, watch.text());
    }
    return text;
}

}  // namespace takt::daemon
