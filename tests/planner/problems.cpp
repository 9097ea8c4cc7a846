#include "problems.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace takt::planner::test {

using core::Acceleration;
using core::Jerk;
using core::Position;
using core::Velocity;
using Real = long double;

std::uint64_t Random::next() noexcept {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
}

double Random::uniform() noexcept {
    return static_cast<double>(next() >> 11U) * 0x1.0p-53;
}

double Random::uniform(double low, double high) noexcept {
    return low + (high - low) * uniform();
}

double Random::logarithmic(double low, double high) noexcept {
    return std::exp(uniform(std::log(low), std::log(high)));
}

int Random::integer(int low, int high) noexcept {
    return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
}

State state(double p, double v, double a) {
    return {Position{p}, Velocity{v}, Acceleration{a}};
}

Limits limits(double v, double a, double j) {
    return limits(v, -v, a, -a, j);
}

Limits limits(double vmax, double vmin, double amax, double amin, double j) {
    return {Velocity{vmax}, Velocity{vmin}, Acceleration{amax}, Acceleration{amin}, Jerk{j}};
}

Target rest(double p) {
    return {TargetKind::State, state(p, 0, 0)};
}

namespace {

bool viable(const State& s, const Limits& l) {
    const double v = s.velocity.count();
    const double a = s.acceleration.count();
    const double swing = a * a / (2 * l.jerk.count());
    return a <= l.maxAcceleration.count() && a >= l.minAcceleration.count() &&
           v + swing <= l.maxVelocity.count() && v - swing >= l.minVelocity.count();
}

State within(Random& random, const Limits& l, double p) {
    for (;;) {
        const double v =
            random.chance(0.8) ? random.uniform(l.minVelocity.count(), l.maxVelocity.count()) : 0.0;
        const double a = random.chance(0.7)
                             ? random.uniform(l.minAcceleration.count(), l.maxAcceleration.count())
                             : 0.0;
        const State s = state(p, v, a);
        if (viable(s, l)) return s;
    }
}

Limits anyLimits(Random& r) {
    return limits(r.uniform(0.1, 10), -r.uniform(0.1, 10), r.uniform(0.1, 10), -r.uniform(0.1, 10),
                  r.uniform(0.1, 50));
}

}  // namespace

Case ordinary(Random& random) {
    const Limits l = anyLimits(random);
    return {within(random, l, random.uniform(-5, 5)),
            {TargetKind::State, within(random, l, random.uniform(-5, 5))},
            l};
}

Case wide(Random& random) {
    const double v = random.logarithmic(1e-3, 1e3);
    const double a = v / random.logarithmic(1e-3, 10);
    const double j = a * a / v * random.logarithmic(1, 1e3);
    const Limits l =
        limits(v, v * -random.logarithmic(0.1, 10), a, a * -random.logarithmic(0.1, 10), j);
    const double way = v * random.logarithmic(1e-6, 100) * (random.chance(0.5) ? 1 : -1);
    return {within(random, l, 0), {TargetKind::State, within(random, l, way)}, l};
}

Case near(Random& random) {
    const double m = random.logarithmic(1e-14, 1);
    const Limits l =
        limits(random.uniform(0.1, 2), random.uniform(0.5, 20), random.uniform(5, 500));
    const auto little = [&] { return random.chance(0.4) ? m * random.uniform(-0.1, 0.1) : 0.0; };
    return {state(0, little(), little()),
            {TargetKind::State, state(m * random.uniform(-1, 1), little(), little())},
            l};
}

namespace {

State onALimit(Random& random, const Limits& l, double p) {
    const bool up = random.chance(0.5);
    const double a = (up ? l.maxAcceleration : l.minAcceleration).count();
    const double v = (up ? l.maxVelocity : l.minVelocity).count();
    const double swing = a * a / (2 * l.jerk.count());
    switch (random.integer(0, 2)) {
        case 0:
            return state(p, v, 0);
        case 1:  // the acceleration is taken back at full jerk to end on the velocity limit
            if (std::fabs(v) > swing) return state(p, up ? v - swing : v + swing, a);
            return state(p, v, 0);
        default:
            return state(p, 0, 0);
    }
}

}  // namespace

Case saturated(Random& random) {
    const Limits l = anyLimits(random);
    for (;;) {
        const Case c{onALimit(random, l, 0),
                     {TargetKind::State, onALimit(random, l, random.uniform(-5, 5))},
                     l};
        if (viable(c.from, l) && viable(c.target.state, l)) return c;
    }
}

Case grid(Random& random) {
    const auto any = [&] { return static_cast<double>(random.integer(-2, 2)); };
    for (;;) {
        Case c{state(any(), any(), any()),
               {TargetKind::State, state(any(), any(), any())},
               limits(random.integer(1, 3), random.integer(1, 3), random.integer(1, 3))};
        if (viable(c.target.state, c.limits)) return c;
    }
}

Case outside(Random& random) {
    Case c = ordinary(random);
    c.from = state(random.uniform(-5, 5), random.uniform(-20, 20), random.uniform(-20, 20));
    return c;
}

std::string describe(const Case& c) {
    char text[512];
    const auto& f = c.from;
    const auto& t = c.target.state;
    const auto& l = c.limits;
    std::snprintf(text, sizeof text,
                  "from (%.17g, %.17g, %.17g) to (%.17g, %.17g, %.17g) within v %.17g %.17g a "
                  "%.17g %.17g j %.17g",
                  f.position.count(), f.velocity.count(), f.acceleration.count(),
                  t.position.count(), t.velocity.count(), t.acceleration.count(),
                  l.maxVelocity.count(), l.minVelocity.count(), l.maxAcceleration.count(),
                  l.minAcceleration.count(), l.jerk.count());
    return text;
}

namespace {

/// Integrates a profile's pieces; the limits are widened by what a start outside them makes
/// inevitable.
class Judge {
public:
    Judge(const Case& c, const Profile& profile) : case_{c}, profile_{profile} {}

    std::string verdict() {
        begin();
        for (std::size_t i = 0; i < profile_.size() && fault_.empty(); ++i) step(profile_[i]);
        if (fault_.empty()) end();
        return fault_;
    }

private:
    void begin() {
        v_ = case_.from.velocity.count();
        a_ = case_.from.acceleration.count();
        const Real swing = a_ * a_ / (2 * static_cast<Real>(case_.limits.jerk.count()));
        vhigh_ = std::max<Real>(case_.limits.maxVelocity.count(), a_ > 0 ? v_ + swing : v_);
        vlow_ = std::min<Real>(case_.limits.minVelocity.count(), a_ < 0 ? v_ - swing : v_);
        ahigh_ = std::max<Real>(case_.limits.maxAcceleration.count(), a_);
        alow_ = std::min<Real>(case_.limits.minAcceleration.count(), a_);
        vscale_ = std::max(vhigh_, -vlow_);
        ascale_ = std::max(ahigh_, -alow_);
        least_ =
            std::min(case_.limits.maxAcceleration.count(), -case_.limits.minAcceleration.count());
    }

    void expect(bool good, const char* what) {
        if (!good && fault_.empty()) fault_ = what;
    }

    void within(Real v, Real a) {
        if (case_.target.kind == TargetKind::State) {
            expect(v <= vhigh_ + 1e-9L * vscale_ && v >= vlow_ - 1e-9L * vscale_, "velocity limit");
        }
        expect(a <= ahigh_ + 1e-9L * ascale_ && a >= alow_ - 1e-9L * ascale_, "acceleration limit");
    }

    void step(const Segment& s) {
        const Real t = s.duration.count();
        const Real j = s.jerk.count();
        expect(t > 0 && std::isfinite(s.duration.count()), "piece without a length");
        expect(std::fabs(j) <= case_.limits.jerk.count() * (1 + 1e-9L), "jerk limit");
        expect(std::fabs(a_ - s.from.acceleration.count()) <= 1e-9L * ascale_,
               "acceleration jumps");
        expect(std::fabs(v_ - s.from.velocity.count()) <= 1e-9L * vscale_, "velocity jumps");
        expect(std::fabs(t_ - s.start.count()) <= 1e-12L * (t_ + t), "pieces do not join");
        if (j != 0) {
            const Real zero = -a_ / j;
            if (zero > 0 && zero < t) within(v_ + zero * a_ / 2, 0);
        }
        way_ += std::fabs(v_) * t + std::fabs(a_) * t * t / 2;
        fastest_ = std::max(fastest_, std::fabs(v_));
        p_ += t * (v_ + t * (a_ / 2 + t * j / 6));
        v_ += t * (a_ + t * j / 2);
        a_ += t * j;
        t_ += t;
        within(v_, a_);
        tighten();
    }

    /// Once back inside, the plain limits hold.
    void tighten() {
        const Limits& l = case_.limits;
        const Real swing = a_ * a_ / (2 * static_cast<Real>(l.jerk.count()));
        if (v_ > l.maxVelocity.count() || v_ < l.minVelocity.count()) return;
        if (a_ > l.maxAcceleration.count() || a_ < l.minAcceleration.count()) return;
        ahigh_ = l.maxAcceleration.count();
        alow_ = l.minAcceleration.count();
        if ((a_ > 0 ? v_ + swing : v_) <= l.maxVelocity.count()) vhigh_ = l.maxVelocity.count();
        if ((a_ < 0 ? v_ - swing : v_) >= l.minVelocity.count()) vlow_ = l.minVelocity.count();
    }

    void end() {
        const State& goal = case_.target.state;
        const Real p0 = case_.from.position.count();
        const Real scale =
            way_ + 1e-3L * fastest_ * t_ + std::fabs(p0) + std::fabs(goal.position.count());
        if (case_.target.kind == TargetKind::State) {
            // A state on the way is known to some ulps of the length the axis needs to stop.
            const Real grain = 64 * std::numeric_limits<double>::epsilon() * vscale_ *
                               (vscale_ / least_ + ascale_ / case_.limits.jerk.count());
            expect(std::fabs(p0 + p_ - goal.position.count()) <= 1e-12L * scale + grain,
                   "position missed");
            expect(profile_.end().position == goal.position, "end position not exact");
        }
        // An acceleration that is one ulp from zero changes the velocity during a long cruise.
        const Real drift = 4 * std::numeric_limits<double>::epsilon() * ascale_ * t_;
        expect(std::fabs(v_ - goal.velocity.count()) <= 1e-12L * vscale_ + drift,
               "velocity missed");
        expect(std::fabs(a_ - goal.acceleration.count()) <= 1e-12L * ascale_,
               "acceleration missed");
        expect(profile_.end().velocity == goal.velocity, "end velocity not exact");
        expect(std::fabs(t_ - profile_.duration().count()) <= 1e-12L * t_,
               "duration is not the sum");
    }

    const Case& case_;
    const Profile& profile_;
    std::string fault_;
    Real t_{0}, p_{0}, fastest_{0}, v_{0}, a_{0}, way_{0};
    Real vhigh_{0}, vlow_{0}, ahigh_{0}, alow_{0}, vscale_{0}, ascale_{0}, least_{0};
};

}  // namespace

std::string judge(const Case& c, const Profile& profile) {
    return Judge{c, profile}.verdict();
}

}  // namespace takt::planner::test
