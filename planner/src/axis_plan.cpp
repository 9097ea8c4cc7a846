#include "axis_plan.hpp"

#include "brake.hpp"
#include "closing.hpp"
#include "profile_builder.hpp"
#include "second_order.hpp"
#include "velocity_problem.hpp"

namespace takt::planner::detail {

double positionGrain(const State& from, const State& to, const Limits& limits) noexcept {
    const double positions = std::fabs(from.position.count()) + std::fabs(to.position.count());
    const double range = (limits.maxVelocity - limits.minVelocity).count();
    const double least = std::min(limits.maxAcceleration.count(), -limits.minAcceleration.count());
    const double length = range * (range / least + least / limits.jerk.count());
    return kEps * (8.0 * positions + (std::isfinite(length) ? 2.0 * length : 0.0));
}

namespace {

Problem problemOf(const State& from, const State& to, const Limits& limits,
                  const Resolution& resolution) noexcept {
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
            positionGrain(from, to, limits),
            resolution.position.count(),
            resolution.velocity.count()};
}

}  // namespace

void AxisPlan::begin(const State& from, const Target& target, const Limits& limits,
                     const Resolution& resolution) noexcept {
    from_ = from;
    target_ = target;
    whole_ = problemOf(from, target.state, limits, resolution);
    inner_ = whole_;
    pieces_.size = 0;
    brakingSize_ = 0;
    brakingTime_ = 0.0;
    if (std::isfinite(whole_.jerk)) {
        order_ = Order::Third;
        beginThirdOrder();
    } else if (std::isfinite(whole_.amax) || std::isfinite(whole_.amin)) {
        order_ = Order::Second;
        beginSecondOrder();
    } else {
        order_ = Order::First;
        beginFirstOrder();
    }
    duration_ += brakingTime_;
}

void AxisPlan::endBraking() noexcept {
    brakingSize_ = pieces_.size;
    for (std::size_t i = 0; i < brakingSize_; ++i) brakingTime_ += pieces_.time[i];
}

void AxisPlan::beginFirstOrder() noexcept {
    const double limit = whole_.distance > 0.0 ? whole_.vmax : whole_.vmin;
    duration_ = target_.kind == TargetKind::Velocity ? 0.0 : whole_.distance / limit;
}

void AxisPlan::beginSecondOrder() noexcept {
    if (target_.kind == TargetKind::Velocity) {
        const double gain = whole_.vf - whole_.v0;
        const double a = gain > 0.0 ? whole_.amax : whole_.amin;
        duration_ = gain / a;
        pieces_.add(duration_, a);
        return;
    }
    brakeSecondOrder(inner_, pieces_);
    endBraking();
    duration_ = fastestSecondOrder(inner_, pieces_);
}

void AxisPlan::beginThirdOrder() noexcept {
    if (target_.kind == TargetKind::Velocity) {
        brakeAcceleration(inner_, pieces_);
        endBraking();
        duration_ = fastestVelocity(inner_, pieces_);
        return;
    }
    brakePosition(inner_, pieces_);
    endBraking();
    fastest_ = detail::fastest(inner_);
    duration_ = fastest_.found ? fastest_.duration : std::nan("");
}

Pieces AxisPlan::braking() const noexcept {
    Pieces pieces;
    for (std::size_t i = 0; i < brakingSize_; ++i) pieces.add(pieces_.time[i], pieces_.value[i]);
    return pieces;
}

double AxisPlan::firstPossible(double notBefore) const noexcept {
    if (notBefore <= duration_) return duration_;
    if (canWait(notBefore)) return notBefore;
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

void AxisPlan::marks(Marks& out) const noexcept {
    Marks all;
    static_cast<void>(all.push(0.0));
    if (order_ == Order::Third && target_.kind == TargetKind::State) {
        detail::marks(inner_, all);
    } else if (order_ == Order::Third) {
        velocityMarks(inner_, all);
    } else if (order_ == Order::Second && target_.kind == TargetKind::State) {
        secondOrderMarks(inner_, all);
    }
    for (double& mark : all) mark = std::max(mark + brakingTime_, duration_);
    std::sort(all.begin(), all.end());
    for (const double mark : all) {
        if (out.empty() || mark > out.back()) static_cast<void>(out.push(mark));
    }
}

void AxisPlan::writeFastest(Profile& out) const noexcept {
    if (order_ == Order::First) return writeFirstOrder(duration_, out);
    Pieces pieces;
    pieces.add(pieces_);
    if (order_ == Order::Third && target_.kind == TargetKind::State) {
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
    Pieces pieces = braking();
    if (!lastingPieces(duration - brakingTime_, pieces)) {
        if (!canWait(duration)) return false;
        piecesOf(inner_, fastest_, pieces);
        pieces.add(duration - duration_, 0.0);
    }
    write(pieces, out);
    ProfileBuilder::setDuration(duration, out);
    return true;
}

bool AxisPlan::canWait(double duration) const noexcept {
    if (order_ != Order::Third || target_.kind != TargetKind::State) return false;
    const double gain = std::fabs(whole_.af) * duration;
    return fastest_.direct && gain <= whole_.nearVelocity &&
           (std::fabs(whole_.vf) + 0.5 * gain) * duration <= whole_.nearDistance;
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
