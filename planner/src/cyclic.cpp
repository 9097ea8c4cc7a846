#include <algorithm>
#include <takt/planner/cyclic.hpp>

namespace takt::planner {

namespace {

bool same(const State& a, const State& b) noexcept {
    return a.position == b.position && a.velocity == b.velocity && a.acceleration == b.acceleration;
}

bool same(const Limits& a, const Limits& b) noexcept {
    return a.maxVelocity == b.maxVelocity && a.minVelocity == b.minVelocity &&
           a.maxAcceleration == b.maxAcceleration && a.minAcceleration == b.minAcceleration &&
           a.jerk == b.jerk;
}

bool same(const Goal& a, const Goal& b) noexcept {
    return a.enabled == b.enabled && a.target.kind == b.target.kind &&
           same(a.target.state, b.target.state) && same(a.limits, b.limits);
}

}  // namespace

CyclicGenerator::CyclicGenerator(std::size_t axes, core::Seconds cycle)
    : trajectory_{axes}, cycle_{cycle} {}

void CyclicGenerator::reset(std::span<const State> states) noexcept {
    std::copy_n(states.begin(), std::min(states.size(), trajectory_.size()), start_.begin());
    moving_ = false;
    cyclesDone_ = 0.0;
}

bool CyclicGenerator::sameAsBefore(std::span<const Goal> goals,
                                   const Timing& timing) const noexcept {
    if (!moving_ || timing.synchronisation != timing_.synchronisation) return false;
    if (timing.cycle != timing_.cycle || timing.minDuration != timing_.minDuration) return false;
    for (std::size_t i = 0; i < goals.size(); ++i) {
        if (!same(goals[i], goals_[i])) return false;
    }
    return true;
}

std::optional<InputFault> CyclicGenerator::planAgain(std::span<const Goal> goals,
                                                     const Timing& timing) noexcept {
    std::array<AxisRequest, Trajectory::maxAxes> requests{};
    std::array<State, Trajectory::maxAxes> now = start_;
    if (moving_) sampleNow(now);
    for (std::size_t i = 0; i < goals.size(); ++i) {
        requests[i] = {now[i], goals[i].target, goals[i].limits, goals[i].enabled, {}};
    }
    const auto result = trajectory_.plan({requests.data(), goals.size()}, timing);
    if (!result.ok()) return result.error();
    std::copy(goals.begin(), goals.end(), goals_.begin());
    start_ = now;
    timing_ = timing;
    cyclesDone_ = 0.0;
    moving_ = true;
    return std::nullopt;
}

void CyclicGenerator::sampleNow(std::span<State> states) const noexcept {
    if (moving_) {
        trajectory_.sample(time(), states);
    } else {
        std::copy_n(start_.begin(), trajectory_.size(), states.begin());
    }
}

std::optional<InputFault> CyclicGenerator::step(std::span<const Goal> goals, const Timing& timing,
                                                std::span<State> states) noexcept {
    std::optional<InputFault> fault;
    if (goals.size() != trajectory_.size()) {
        fault = InputFault{PlanError::InvalidLimits, InputField::Axes, 0};
    } else if (!sameAsBefore(goals, timing)) {
        fault = planAgain(goals, timing);
    }
    if (moving_) cyclesDone_ += 1.0;
    sampleNow(states);
    return fault;
}

}  // namespace takt::planner
