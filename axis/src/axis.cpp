#include <algorithm>
#include <cmath>
#include <takt/axis/axis.hpp>

#include "cycles.hpp"

namespace takt::axis {

using core::Distance;
using core::Position;
using core::Velocity;

namespace {

AxisTraits traitsOf(const AxisParams& params, const Scaling& scaling) {
    AxisTraits traits;
    traits.limits = params.limits;
    traits.period = scaling.period();
    traits.resolution = scaling.resolution();
    traits.maxPosition = scaling.maxPosition();
    traits.queueDepth =
        std::clamp(params.queueDepth, 1U, static_cast<std::uint32_t>(Axis::MaxQueue));
    traits.powerOff = params.powerOff;
    return traits;
}

/// Twice the fastest the motor can turn, or four times the axis' velocity limit when that is not
/// told.
std::int64_t jumpCountsOf(const AxisParams& params, const Scaling& scaling, double cycle) {
    constexpr double kNoise = 64.0;
    const double limit = 4.0 * params.limits.velocity.count() / scaling.resolution().count();
    const double motor = 2.0 * params.drive.maxMotorSpeed.count() *
                         static_cast<double>(params.scaling.countsPerTurn);
    return static_cast<std::int64_t>(std::max(limit, motor) * cycle + kNoise);
}

double secondsOf(core::Duration time) {
    return std::chrono::duration<double>(time).count();
}

}  // namespace

const char* name(AxisState state) noexcept {
    switch (state) {
        case AxisState::Disabled:
            return "Disabled";
        case AxisState::Standstill:
            return "Standstill";
        case AxisState::Homing:
            return "Homing";
        case AxisState::DiscreteMotion:
            return "DiscreteMotion";
        case AxisState::ContinuousMotion:
            return "ContinuousMotion";
        case AxisState::SynchronizedMotion:
            return "SynchronizedMotion";
        case AxisState::Stopping:
            return "Stopping";
        case AxisState::ErrorStop:
            return "ErrorStop";
    }
    return "?";
}

Axis::Axis(const AxisParams& params, core::Duration cycle)
    : name_{params.name},
      scaling_{params.scaling},
      traits_{traitsOf(params, scaling_)},
      drive_{params, cycle},
      motion_{traits_, cycle},
      gate_{traits_, cycle},
      followingError_{params.supervision, cycle},
      cycleSeconds_{secondsOf(cycle)},
      lostCycles_{params.supervision.lostCycles},
      resetLimit_{cyclesFor(params.supervision.resetTimeout, cycle)},
      inPositionWindow_{params.supervision.inPositionWindow},
      inPositionCycles_{cyclesFor(params.supervision.inPositionTime, cycle)},
      jumpCounts_{jumpCountsOf(params, scaling_, secondsOf(cycle))},
      enableTimeout_{secondsOf(params.supervision.enableTimeout)} {
    view_.traits = &traits_;
}

void Axis::attach(core::DeviceImage image, const DriveBindings& bindings,
                  core::ObjectAccess* objects) {
    drive_.attach(image, bindings, objects);
}

void Axis::readInputs(core::CycleNumber cycle) noexcept {
    view_.cycle = cycle;
    const bool firstInputs = !drive_.inputs().seen;
    drive_.readInputs();
    updateActual();
    // Without a drive that follows, the set-point rests on the actual position: no jump later.
    if (firstInputs || !drive_.following()) standAtActual();
    updateHoming();
    supervise();
    updatePower();
    updateReset();
    updateMotion();
    applyPower();
    publishSet();
}

void Axis::updateActual() noexcept {
    const DriveInputs& in = drive_.inputs();
    const core::DeviceHealth& health = drive_.health();
    view_.inputsValid = in.seen && health.operational && health.lostInRow <= lostCycles_;
    view_.actual = scaling_.toUnits(in.counts);
    actualVelocity_ = Velocity{scaling_.toDistance(in.step).count() / cycleSeconds_};
    lag_ = drive_.following() ? followingError_.lag(view_.actual) : Distance{};
}

void Axis::standAtActual() noexcept {
    motion_.hold(view_.actual);
    gate_.prime(view_.actual);
    followingError_.reset(view_.actual);
    lag_ = Distance{};
    emergency_ = false;
}

void Axis::updateHoming() noexcept {
    if (!homingRunning_) return;
    if (!drive_.homing() && drive_.homingOutcome() == HomingOutcome::Cancelled) {
        homingRunning_ = false;
        standAtActual();
        return;
    }
    if (drive_.stuckInHoming()) {
        const double shown = drive_.inputs().modeDisplay;
        raise(ErrorId::ModeChangeFailed, {8.0, shown, 0.0}, Reaction::DriveStop);
        return;
    }
    if (drive_.homing()) return;

    homingRunning_ = false;
    const HomingOutcome outcome = drive_.homingOutcome();
    if (outcome == HomingOutcome::Done && view_.state == AxisState::Homing) {
        scaling_.setOrigin(0, active_.position);
        view_.homed = true;
        updateActual();
    }
    standAtActual();
    if (view_.state != AxisState::Homing) return;
    view_.commandedPosition = view_.actual;
    CommandStatus status{CommandPhase::Done, ErrorId::None};
    if (outcome == HomingOutcome::DriveError)
        status = {CommandPhase::Error, ErrorId::HomingDriveError};
    if (outcome == HomingOutcome::TimedOut) status = {CommandPhase::Error, ErrorId::HomingTimeout};
    if (outcome == HomingOutcome::ModeFailed)
        status = {CommandPhase::Error, ErrorId::ModeChangeFailed};
    completeActive(status);
}

void Axis::updateMotion() noexcept {
    if (planPending_ || homingRunning_) return;
    switch (view_.state) {
        case AxisState::DiscreteMotion:
            updateDiscrete();
            return;
        case AxisState::ContinuousMotion:
            updateContinuous();
            return;
        case AxisState::Stopping:
            updateStopping();
            return;
        case AxisState::Disabled:
        case AxisState::Standstill:
        case AxisState::Homing:
        case AxisState::SynchronizedMotion:
        case AxisState::ErrorStop:
            return;
    }
}

void Axis::updateDiscrete() noexcept {
    if (!motion_.finished()) return;
    const bool positions =
        active_.kind == CommandKind::MoveAbsolute || active_.kind == CommandKind::MoveRelative;
    if (positions && !inPosition()) return;
    completeActive({CommandPhase::Done, ErrorId::None});
}

bool Axis::inPosition() noexcept {
    if (inPositionWindow_ <= Distance{}) return true;
    const Distance off = motion_.target() - view_.actual;
    const bool inside = off <= inPositionWindow_ && off >= -inPositionWindow_;
    inPositionSince_ = inside ? inPositionSince_ + 1 : 0;
    return inside && inPositionSince_ >= inPositionCycles_;
}

void Axis::updateContinuous() noexcept {
    if (motion_.limitHit()) {
        report(active_.id, {CommandPhase::Error, ErrorId::SWLimitReached});
        view_.active = CommandId::None;
        view_.inVelocity = false;
        if (!queue_.empty()) {
            activateNext();
            return;
        }
        // The stop at the limit is under way already; it ends like any other positioning.
        view_.state = AxisState::DiscreteMotion;
        active_ = Command{};
        return;
    }
    view_.inVelocity = motion_.finished();
    if (view_.inVelocity && !queue_.empty()) {
        report(active_.id, {CommandPhase::Aborted, ErrorId::None});
        activateNext();
    }
}

void Axis::updateStopping() noexcept {
    if (!motion_.resting()) return;
    if (!view_.stopDone) {
        view_.stopDone = true;
        report(view_.active, {CommandPhase::Done, ErrorId::None});
    }
    if (view_.stopReleased) enterStandstill();
}

void Axis::step() noexcept {
    if (planPending_) planActive();
    if (drive_.following() && view_.state != AxisState::Disabled) {
        advance();
    } else {
        gate_.prime(motion_.set().position);
    }
    drive_.setTarget(scaling_.toCounts(motion_.set().position));
    followingError_.push(motion_.set().position);
    publishSet();
}

void Axis::missCycle() noexcept {
    drive_.missCycles(1);
    step();
}

void Axis::advance() noexcept {
    if (emergency_) {
        brakeByGate();
        return;
    }
    const planner::State next = view_.grouped ? led_ : motion_.next();
    const Position last = motion_.set().position;
    if (gate_.judge(next.position) != OutputGate::Verdict::Pass) {
        refuse(ErrorId::SetpointJump,
               {next.position.count(), last.count(), static_cast<double>(active_.kind)});
    } else if (const auto limit = softLimitPassed(next.position)) {
        refuse(ErrorId::SWLimitReached, {next.position.count(), limit->count(), 0.0});
    } else {
        gate_.accept(next.position);
        if (view_.grouped) {
            motion_.lead(next);
        } else {
            motion_.accept(next);
        }
    }
}

void Axis::refuse(ErrorId error, Numbers numbers) noexcept {
    // The value never leaves: the axis brakes from its last good state, and by itself.
    view_.grouped = false;
    raise(error, numbers, Reaction::Ramp);
    const planner::State next = motion_.next();
    if (emergency_ || gate_.judge(next.position) != OutputGate::Verdict::Pass) {
        emergency_ = true;
        brakeByGate();
        return;
    }
    gate_.accept(next.position);
    motion_.accept(next);
}

void Axis::brakeByGate() noexcept {
    const Position braked = gate_.braked();
    gate_.accept(braked);
    motion_.force(braked, Velocity{gate_.lastStep().count() / cycleSeconds_});
    emergency_ = !motion_.resting();
}

std::optional<Position> Axis::softLimitPassed(Position next) const noexcept {
    if (!live()) return std::nullopt;
    const LimitParams& limits = traits_.limits;
    // Half a count is rounding. An axis that stands outside may move inward.
    const Distance tolerance = traits_.resolution / 2.0;
    const Position set = motion_.set().position;
    if (limits.softPositive && next > *limits.softPositive + tolerance && next > set) {
        return limits.softPositive;
    }
    if (limits.softNegative && next < *limits.softNegative - tolerance && next < set) {
        return limits.softNegative;
    }
    return std::nullopt;
}

void Axis::publishSet() noexcept {
    const planner::State& set = motion_.set();
    view_.set = set.position;
    view_.setVelocity = set.velocity;
    view_.atRest = motion_.resting();
    if (set.velocity > Velocity{}) view_.movedBackward = false;
    if (set.velocity < Velocity{}) view_.movedBackward = true;
}

void Axis::writeOutputs() noexcept {
    drive_.writeOutputs();
}

AxisStatus Axis::status() const noexcept {
    AxisStatus s;
    s.state = view_.state;
    s.set = motion_.set().position;
    s.setVelocity = motion_.set().velocity;
    s.setAcceleration = motion_.set().acceleration;
    s.target = drive_.target();
    s.actual = view_.actual;
    s.actualVelocity = actualVelocity_;
    s.lag = lag_;
    s.controlword = drive_.controlword();
    s.statusword = drive_.inputs().statusword;
    s.mode = drive_.inputs().modeDisplay;
    s.error = view_.error.id;
    s.driveError = drive_.inputs().errorCode;
    s.powered = view_.powered;
    s.homed = view_.homed;
    s.commandedPosition = view_.commandedPosition;
    return s;
}

}  // namespace takt::axis
