#include "homing.hpp"

#include <cmath>

namespace takt::twin {

namespace {

double distance(double a, double b) noexcept {
    return a > b ? a - b : b - a;
}

/// The edge of a switch that lies nearer: what a latch in hardware records.
double edgeNear(const std::optional<SwitchParams>& zone, double position) noexcept {
    if (!zone) return position;
    return distance(zone->fromTurns, position) < distance(zone->toTurns, position) ? zone->fromTurns
                                                                                   : zone->toTurns;
}

}  // namespace

HomingSignals Homing::signalsOf(const Motor& motor) const noexcept {
    return {motor.homeSwitch() || forced_.home, motor.positiveLimit() || forced_.positive,
            motor.negativeLimit() || forced_.negative};
}

void Homing::sample(const Motor& motor) noexcept {
    signals_ = signalsOf(motor);
    position_ = motor.position();
}

void Homing::start(const HomingSettings& settings, const Motor& motor,
                   MotionGenerator& generator) noexcept {
    settings_ = settings;
    state_ = State::Searching;
    at_ = 0;
    stopping_ = false;
    zero_.reset();
    sample(motor);
    if (homesInPlace(settings.method)) {
        sequence_ = nullptr;
        event_ = motor.position();
        eventIsIndex_ = false;
        settle(motor, generator);
        return;
    }
    sequence_ = findHoming(settings.traits, settings.method, signals_);
    if (sequence_ == nullptr) {
        fail(generator);
        return;
    }
    beginStep(motor, generator);
}

void Homing::beginStep(const Motor& motor, MotionGenerator& generator) noexcept {
    const HomingStep& step = sequence_->steps[at_];
    stopping_ = false;
    sample(motor);
    generator.run(step.direction * speedOf(step), settings_.acceleration);
}

double Homing::speedOf(const HomingStep& step) const noexcept {
    const HomingTraits& traits = settings_.traits;
    const bool onlyIndex = step.event == HomingEvent::Index && sequence_->count == 1;
    const bool fast = step.speed == HomingSpeed::Fast ||
                      (step.speed == HomingSpeed::BackOff && !traits.backsOffSlowly) ||
                      (onlyIndex && traits.indexSearchFast);
    return fast ? settings_.fastSpeed : settings_.slowSpeed;
}

void Homing::interrupt(MotionGenerator& generator) noexcept {
    if (state_ == State::Idle || state_ == State::Done || state_ == State::Failed) return;
    state_ = State::Interrupted;
    generator.run(0.0, settings_.acceleration);
}

void Homing::fail(MotionGenerator& generator) noexcept {
    state_ = State::Failed;
    generator.run(0.0, settings_.acceleration);
}

bool Homing::happened(const HomingStep& step, const Motor& motor, double torque,
                      const MotionGenerator& generator) noexcept {
    const MechanicsParams& parts = motor.params();
    eventIsIndex_ = step.event == HomingEvent::Index;
    const HomingSignals now = signalsOf(motor);
    const auto edge = [&](bool before, bool after, bool on,
                          const std::optional<SwitchParams>& zone) {
        if (before == after || after != on) return false;
        event_ = edgeNear(zone, motor.position());
        return true;
    };
    switch (step.event) {
        case HomingEvent::HomeOn:
            return edge(signals_.home, now.home, true, parts.homeSwitch);
        case HomingEvent::HomeOff:
            return edge(signals_.home, now.home, false, parts.homeSwitch);
        case HomingEvent::PositiveOn:
            return edge(signals_.positive, now.positive, true, parts.positiveLimit);
        case HomingEvent::PositiveOff:
            return edge(signals_.positive, now.positive, false, parts.positiveLimit);
        case HomingEvent::NegativeOn:
            return edge(signals_.negative, now.negative, true, parts.negativeLimit);
        case HomingEvent::NegativeOff:
            return edge(signals_.negative, now.negative, false, parts.negativeLimit);
        case HomingEvent::HardStop:
            event_ = motor.position();
            return motor.atRest() && distance(torque, 0.0) > settings_.blockTorque;
        case HomingEvent::Index:
            break;
    }
    const bool slowingDown = distance(generator.demand().velocity, 0.0) > speedOf(step);
    if (settings_.traits.indexAtSlowSpeedOnly && slowingDown) return false;
    return passedIndex(step.direction, motor);
}

bool Homing::passedIndex(int direction, const Motor& motor) noexcept {
    // The pulse repeats every turn; mirrored for the negative direction.
    const double phase = motor.params().indexTurns;
    const double sign = direction > 0 ? 1.0 : -1.0;
    const double before = std::floor(sign * (position_ - phase));
    const double now = std::floor(sign * (motor.position() - phase));
    if (now <= before) return false;
    event_ = sign * now + phase;
    return true;
}

bool Homing::blocked(const HomingStep& step, const Motor& motor) const noexcept {
    // A limit switch in the direction of travel that the method does not ask for ends the run.
    const bool asksPositive =
        step.event == HomingEvent::PositiveOn || step.event == HomingEvent::PositiveOff;
    const bool asksNegative =
        step.event == HomingEvent::NegativeOn || step.event == HomingEvent::NegativeOff;
    const HomingSignals now = signalsOf(motor);
    return step.direction > 0 ? now.positive && !asksPositive : now.negative && !asksNegative;
}

void Homing::step(const Motor& motor, double torque, MotionGenerator& generator) noexcept {
    switch (state_) {
        case State::Idle:
        case State::Done:
        case State::Interrupted:
        case State::Failed:
            return;
        case State::Settling:
            settle(motor, generator);
            return;
        case State::ToOffset:
            if (generator.finished()) arrive(generator);
            return;
        case State::Searching:
            break;
    }
    const HomingStep& step = sequence_->steps[at_];
    if (stopping_) {
        if (!generator.finished()) return;
        ++at_;
        beginStep(motor, generator);
        return;
    }
    if (happened(step, motor, torque, generator) || turnsAtLimit(step, motor)) {
        act(sequence_->steps[at_], motor, generator);
    } else if (blocked(step, motor)) {
        fail(generator);
        return;
    }
    sample(motor);
}

bool Homing::turnsAtLimit(const HomingStep& step, const Motor& motor) noexcept {
    if (at_ != 0 || sequence_->start != HomingStart::OffHome) return false;
    const HomingSignals now = signalsOf(motor);
    const bool limit = step.direction > 0 ? now.positive : now.negative;
    const HomingSequence* after = limit ? findAfterLimit(settings_.method) : nullptr;
    if (after == nullptr) return false;
    sequence_ = after;
    return true;
}

void Homing::act(const HomingStep& step, const Motor& motor, MotionGenerator& generator) noexcept {
    switch (step.action) {
        case HomingAction::Stop:
            stopping_ = true;
            generator.run(0.0, settings_.acceleration);
            return;
        case HomingAction::Go:
            ++at_;
            beginStep(motor, generator);
            return;
        case HomingAction::Finish:
            found(step, motor, generator);
            return;
    }
}

void Homing::found(const HomingStep& step, const Motor& motor,
                   MotionGenerator& generator) noexcept {
    if (step.event == HomingEvent::HardStop) {
        // Back from the stop by the home offset; only there is home. The demand has run on into
        // the stop: it starts again where the motor stands.
        generator.begin({motor.position(), 0.0, 0.0});
        home_ = motor.position() - step.direction * distance(settings_.offset, 0.0);
        zero_ = home_;
        state_ = State::ToOffset;
        generator.moveTo(home_, settings_.offsetSpeed, settings_.acceleration);
        return;
    }
    state_ = State::Settling;
    if (settings_.traits.reference == HomeReference::LatchedEdge) {
        // The servo locks at once, without a ramp.
        generator.begin({motor.position(), 0.0, 0.0});
    } else {
        generator.run(0.0, settings_.acceleration);
    }
}

void Homing::settle(const Motor& motor, MotionGenerator& generator) noexcept {
    state_ = State::Settling;
    // Standing means the motor, not only its demand: less than a millionth of a turn in a
    // millisecond.
    constexpr double AlmostZero = 1e-3;
    if (!generator.finished() || distance(motor.velocity(), 0.0) > AlmostZero) return;
    const bool latched =
        settings_.traits.reference == HomeReference::LatchedEdge ||
        (eventIsIndex_ && (settings_.movesToOffset || !settings_.traits.offsetAtRestPoint));
    home_ = latched ? event_ : motor.position();
    if (!settings_.movesToOffset) {
        state_ = State::Done;
        return;
    }
    const double target = home_ + settings_.offset;
    zero_ = target;
    state_ = State::ToOffset;
    if (!latched && settings_.offset == 0.0) {
        generator.begin({home_, 0.0, 0.0});
        arrive(generator);
        return;
    }
    generator.moveTo(target, settings_.offsetSpeed, settings_.acceleration);
}

void Homing::arrive(MotionGenerator& generator) noexcept {
    const Demand stand = generator.demand();
    generator.begin(stand);
    state_ = State::Done;
}

}  // namespace takt::twin
