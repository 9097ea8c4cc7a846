#include "axis_plan.hpp"

#include "brake.hpp"
#include "closing.hpp"
#include "profile_builder.hpp"
#include "second_order.hpp"
#include "velocity_problem.hpp"

namespace takt::planner::detail {

namespace {

Problem problemOf(const State& from, const State& to, const Limits& limits) noexcept {
    const double p0 = from.position.count();
    const double pf = to.position.count();
    return {from.velocity.count(),
            from.acceleration.count(),
            to.velocity.count(),
            to.acceleration.count(),
            pf - p0,
            limits.maxVelocity.count(),
            limits.minVelocity.count(),
            limits.maxAcceleration.count(),
            limits.minAcceleration.count(),
            limits.jerk.count(),
            8.0 * kEps * (std::fabs(p0) + std::fabs(pf))};
}

}  // namespace

AxisPlan::AxisPlan(const State& from, const Target& target, const Limits& limits) noexcept
    : from_{from}, target_{target}, whole_{problemOf(from, target.state, limits)}, inner_{whole_} {
    if (std::isinf(whole_.jerk)) {
        order_ = std::isinf(whole_.amax) && std::isinf(whole_.amin) ? Order::First : Order::Second;
    }
    begin();
}

void AxisPlan::begin() noexcept {
    const bool toVelocity = target_.kind == TargetKind::Velocity;
    Pieces unused;
    if (order_ == Order::First) {
        const double limit = whole_.distance > 0.0 ? whole_.vmax : whole_.vmin;
        duration_ = toVelocity ? 0.0 : whole_.distance / limit;
    } else if (order_ == Order::Second) {
        if (!toVelocity) brakeSecondOrder(inner_, braking_);
        duration_ = toVelocity ? secondVelocity(unused) : fastestSecondOrder(inner_, unused);
    } else if (toVelocity) {
        brakeAcceleration(inner_, braking_);
        duration_ = fastestVelocity(inner_, unused);
    } else {
        brakePosition(inner_, braking_);
        fastest_ = detail::fastest(inner_);
        duration_ = fastest_.found ? fastest_.duration : std::nan("");
    }
    for (std::size_t i = 0; i < braking_.size; ++i) brakingTime_ += braking_.time[i];
    duration_ += brakingTime_;
}

double AxisPlan::secondVelocity(Pieces& out) const noexcept {
    const double gain = whole_.vf - whole_.v0;
    const double a = gain > 0.0 ? whole_.amax : whole_.amin;
    out.add(gain / a, a);
    return gain / a;
}

double AxisPlan::firstPossible(double notBefore) const noexcept {
    if (notBefore <= duration_) return duration_;
    const double left = notBefore - brakingTime_;
    double least = left;
    if (target_.kind == TargetKind::Velocity) {
        if (order_ == Order::Third) least = firstPossibleVelocity(inner_, left);
    } else if (order_ == Order::Second) {
        least = firstPossibleSecondOrder(inner_, left);
    } else if (order_ == Order::Third) {
        least = detail::firstPossible(inner_, left).duration;
    }
    return least <= left ? notBefore : least + brakingTime_;
}

void AxisPlan::writeFastest(Profile& out) const noexcept {
    if (order_ == Order::First) return writeFirstOrder(duration_, out);
    Pieces pieces = braking_;
    const bool toVelocity = target_.kind == TargetKind::Velocity;
    if (order_ == Order::Second) {
        if (toVelocity) {
            static_cast<void>(secondVelocity(pieces));
        } else {
            fastestSecondOrder(inner_, pieces);
        }
    } else if (toVelocity) {
        fastestVelocity(inner_, pieces);
    } else {
        piecesOf(inner_, fastest_, pieces);
    }
    write(pieces, out);
}

bool AxisPlan::lastingPieces(double duration, Pieces& out) const noexcept {
    if (target_.kind == TargetKind::Velocity) {
        if (order_ == Order::Third) return velocityLasting(inner_, duration, out);
        out.add(duration, (whole_.vf - whole_.v0) / duration);
        return true;
    }
    return order_ == Order::Second ? lastingSecondOrder(inner_, duration, out)
                                   : lasting(inner_, duration, out);
}

bool AxisPlan::writeLasting(double duration, Profile& out) const noexcept {
    if (duration <= duration_ * (1.0 + 4.0 * kEps)) {
        if (duration < duration_ * (1.0 - kClip)) return false;
        writeFastest(out);
        ProfileBuilder::setDuration(duration, out);
        return true;
    }
    if (order_ == Order::First) {
        writeFirstOrder(duration, out);
        return true;
    }
    Pieces pieces = braking_;
    if (!lastingPieces(duration - brakingTime_, pieces)) return false;
    write(pieces, out);
    ProfileBuilder::setDuration(duration, out);
    return true;
}

void AxisPlan::write(Pieces& pieces, Profile& out) const noexcept {
    const bool toVelocity = target_.kind == TargetKind::Velocity;
    State end = target_.state;
    if (order_ == Order::Second) {
        ProfileBuilder::withAccelerations(from_, pieces, out);
        end.acceleration = core::Acceleration{0.0};
    } else if (!toVelocity && closeOnTarget(whole_, pieces)) {
        ProfileBuilder::withJerksExactly(from_, pieces, out);
    } else {
        ProfileBuilder::withJerks(from_, pieces, out);
    }
    if (toVelocity) end.position = out.end().position;
    ProfileBuilder::closeOn(end, out);
}

void AxisPlan::writeFirstOrder(double duration, Profile& out) const noexcept {
    const bool toVelocity = target_.kind == TargetKind::Velocity;
    Pieces pieces;
    if (!toVelocity) pieces.add(duration, whole_.distance / duration);
    ProfileBuilder::withVelocities(from_, pieces, out);
    State end = target_.state;
    end.acceleration = core::Acceleration{0.0};
    if (toVelocity) end.position = from_.position;
    ProfileBuilder::closeOn(end, out);
    ProfileBuilder::setDuration(duration, out);
}

}  // namespace takt::planner::detail
