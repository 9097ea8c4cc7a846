#include <cassert>
#include <cmath>
#include <takt/planner/trajectory.hpp>

#include "line.hpp"

namespace takt::planner {

using core::Seconds;

namespace {

/// A straight line is worth a millionth of the time.
constexpr double kAsFast = 1.0 + 9e-7;

std::optional<InputFault> checkTiming(const Timing& timing) noexcept {
    const auto refuse = [](double value, InputField field) -> std::optional<InputFault> {
        if (!std::isfinite(value)) return InputFault{PlanError::NotFinite, field, 0};
        if (value < 0.0) return InputFault{PlanError::InvalidLimits, field, 0};
        return std::nullopt;
    };
    const auto fault = refuse(timing.cycle.count(), InputField::Cycle);
    return fault ? fault : refuse(timing.minDuration.count(), InputField::MinDuration);
}

std::optional<InputFault> checkAll(std::span<const AxisRequest> requests,
                                   const Timing& timing) noexcept {
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (!requests[i].enabled) continue;
        auto fault = findFault(requests[i].from, requests[i].target, requests[i].limits);
        if (!fault) continue;
        fault->axis = static_cast<std::uint8_t>(i);
        return fault;
    }
    return checkTiming(timing);
}

}  // namespace

Trajectory::Trajectory(std::size_t axes)
    : current_(axes), next_(axes), work_{std::make_unique<detail::Group>()} {
    assert(axes >= 1 && axes <= maxAxes);
}

Trajectory::~Trajectory() = default;
Trajectory::Trajectory(Trajectory&&) noexcept = default;
Trajectory& Trajectory::operator=(Trajectory&&) noexcept = default;

core::Result<Seconds, InputFault> Trajectory::plan(std::span<const AxisRequest> requests,
                                                   const Timing& timing) noexcept {
    if (requests.size() != size()) {
        return InputFault{PlanError::InvalidLimits, InputField::Axes, 0};
    }
    if (const auto fault = checkAll(requests, timing)) return *fault;
    detail::Group& group = *work_;
    group.requests = requests;
    group.cycle = timing.cycle.count();
    group.minDuration = timing.minDuration.count();
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (!requests[i].enabled) continue;
        group.plans[i].begin(requests[i].from, requests[i].target, requests[i].limits,
                             requests[i].resolution);
        if (!(group.plans[i].duration() >= 0.0)) {
            return InputFault{PlanError::NoSolution, InputField::None,
                              static_cast<std::uint8_t>(i)};
        }
    }
    bool straight = false;
    const std::optional<double> duration = write(timing.synchronisation, straight);
    if (!duration) return InputFault{PlanError::NoSolution, InputField::None, 0};
    current_.swap(next_);
    straight_ = straight;
    duration_ = Seconds{*duration};
    return duration_;
}

std::optional<double> Trajectory::write(Synchronisation wanted, bool& straight) noexcept {
    const detail::Group& group = *work_;
    switch (wanted) {
        case Synchronisation::None:
            return detail::writeEach(group, next_);
        case Synchronisation::Time:
        case Synchronisation::TimeIfNecessary:
            return detail::writeTogether(group, wanted == Synchronisation::TimeIfNecessary, next_);
        case Synchronisation::Phase:
        case Synchronisation::Line:
            break;
    }
    return writeStraight(wanted == Synchronisation::Line, straight);
}

std::optional<double> Trajectory::writeStraight(bool atAnyPrice, bool& straight) noexcept {
    detail::Group& group = *work_;
    const auto line = detail::findLine(group.requests);
    Profile leader;
    straight = line && detail::planLine(group, *line, leader);
    std::optional<double> other;
    if (!straight) return detail::writeTogether(group, false, next_);
    const double duration = leader.duration().count();
    if (!atAnyPrice && duration > detail::slowest(group) * kAsFast) {
        other = detail::writeTogether(group, false, next_);
        straight = !other || duration <= *other * kAsFast;
    }
    if (!straight) return other;
    detail::writeLine(group, *line, leader, next_);
    return duration;
}

void Trajectory::sample(Seconds time, std::span<State> states) const noexcept {
    for (std::size_t i = 0; i < current_.size(); ++i) {
        states[i] = planner::sample(current_[i], time);
    }
}

}  // namespace takt::planner
