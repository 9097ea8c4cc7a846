#include "program_host.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include <takt/core/cycle_guard.hpp>

namespace takt::daemon {

ProgramHost::ProgramHost(program::ProgramParams params, program::ProgramPtr program,
                         std::size_t axisCount, std::uint16_t number)
    : params_{std::move(params)}, program_{std::move(program)}, ports_(axisCount) {
    for (Port& port : ports_) port.area = std::make_unique<axis::AxisPort>(number);
}

std::vector<std::string> ProgramHost::start(const Axes& axes, core::Duration cycle) {
    std::vector<program::Machine::NamedAxis> named;
    std::string known;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        named.push_back({axes[i].name(), axis::AxisRef{*ports_[i].area}});
        known += (i == 0 ? "" : ", ") + axes[i].name();
    }
    machine_ = std::make_unique<program::Machine>(std::move(named), cycle * params_.everyCycles);
    std::vector<std::string> problems;
    try {
        program_->start(*machine_);
        program_->describe(inspector_);
    } catch (const std::exception& error) {
        problems.push_back(fmt::format("program '{}' threw in start: {}", name(), error.what()));
    } catch (...) {
        problems.push_back(fmt::format("program '{}' threw in start", name()));
    }
    for (const std::string& axis : machine_->unknownAxes()) {
        problems.push_back(fmt::format("program '{}' asks for axis '{}', which does not exist; allowed: {}",
                                       name(), axis, known));
    }
    return problems;
}

void ProgramHost::cycle(core::CycleNumber cycle, Axes& axes) noexcept {
    if (ended() || held_ || cycle % params_.everyCycles != 0) return;
    for (std::size_t i = 0; i < axes.size(); ++i) axes[i].openPort(*ports_[i].area);
    call(cycle);
    const bool commandsCount = phase_ == ProgramPhase::Running || phase_ == ProgramPhase::Finished;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        Port& port = ports_[i];
        port.used = port.used || !port.area->commands().empty();
        if (commandsCount) {
            axes[i].takeCommands(*port.area);
        } else if (port.used) {
            axes[i].stopByProgramLoss();
        }
    }
}

void ProgramHost::call(core::CycleNumber cycle) noexcept {
    phase_ = ProgramPhase::Running;
    machine_->setCycle(calls_++);
    const core::ProgramCallGuard section;
    try {
        switch (program_->cycle(*machine_)) {
            case program::ProgramState::Running: break;
            case program::ProgramState::Finished: end(ProgramPhase::Finished, {}, cycle); break;
            case program::ProgramState::Failed:
                end(ProgramPhase::Failed, machine_->failure(), cycle);
                break;
        }
    } catch (const std::exception& error) {
        end(ProgramPhase::Threw, error.what(), cycle);
    } catch (...) {
        end(ProgramPhase::Threw, "an exception that is not a std::exception", cycle);
    }
}

void ProgramHost::hold(Axes& axes) noexcept {
    if (ended() || held_) return;
    held_ = true;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (ports_[i].used) axes[i].stopByProgramLoss();
    }
}

void ProgramHost::end(ProgramPhase phase, std::string_view why, core::CycleNumber cycle) noexcept {
    phase_ = phase;
    endCycle_ = cycle;
    failureSize_ = std::min(why.size(), failure_.size());
    std::copy_n(why.begin(), failureSize_, failure_.begin());
}

void ProgramHost::stop() {
    if (!program_) return;
    try {
        program_->stop();
    } catch (...) {
        // The machine is already safe; what a program throws in its farewell changes nothing.
        return;
    }
}

std::string ProgramHost::watches() const {
    std::string text;
    for (const program::Watch& watch : inspector_.watches()) {
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", watch.name, watch.text());
    }
    return text;
}

}  // namespace takt::daemon
