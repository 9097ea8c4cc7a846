#include "profile_builder.hpp"

#include "double_double.hpp"

namespace takt::planner {

using core::Acceleration;
using core::Distance;
using core::Jerk;
using core::Seconds;
using core::Velocity;

void ProfileBuilder::withJerks(const State& from, const detail::Pieces& pieces,
                               Profile& out) noexcept {
    double t = 0.0;
    double p = 0.0;
    double v = from.velocity.count();
    double a = from.acceleration.count();
    for (std::size_t i = 0; i < pieces.size; ++i) {
        const double dt = pieces.time[i];
        const double j = pieces.value[i];
        out.segments_[i] = {Seconds{t},
                            Seconds{dt},
                            {from.position + Distance{p}, Velocity{v}, Acceleration{a}},
                            Jerk{j}};
        t += dt;
        p += dt * (v + dt * (0.5 * a + dt * j * (1.0 / 6.0)));
        v += dt * (a + 0.5 * dt * j);
        a += dt * j;
    }
    out.size_ = static_cast<std::uint8_t>(pieces.size);
    out.duration_ = Seconds{t};
    out.end_ = {from.position + Distance{p}, Velocity{v}, Acceleration{a}};
}

void ProfileBuilder::withJerksExactly(const State& from, const detail::Pieces& pieces,
                                      Profile& out) noexcept {
    detail::ExactState exact;
    exact.v.high = from.velocity.count();
    exact.a.high = from.acceleration.count();
    const auto rounded = [&] {
        return State{from.position + Distance{exact.p.value()}, Velocity{exact.v.value()},
                     Acceleration{exact.a.value()}};
    };
    double t = 0.0;
    for (std::size_t i = 0; i < pieces.size; ++i) {
        const double dt = pieces.time[i];
        out.segments_[i] = {Seconds{t}, Seconds{dt}, rounded(), Jerk{pieces.value[i]}};
        exact.advance(dt, pieces.value[i]);
        t += dt;
    }
    out.size_ = static_cast<std::uint8_t>(pieces.size);
    out.duration_ = Seconds{t};
    out.end_ = rounded();
}

void ProfileBuilder::withAccelerations(const State& from, const detail::Pieces& pieces,
                                       Profile& out) noexcept {
    double t = 0.0;
    double p = 0.0;
    double v = from.velocity.count();
    for (std::size_t i = 0; i < pieces.size; ++i) {
        const double dt = pieces.time[i];
        const double a = pieces.value[i];
        out.segments_[i] = {Seconds{t},
                            Seconds{dt},
                            {from.position + Distance{p}, Velocity{v}, Acceleration{a}},
                            Jerk{}};
        t += dt;
        p += dt * (v + 0.5 * dt * a);
        v += dt * a;
    }
    out.size_ = static_cast<std::uint8_t>(pieces.size);
    out.duration_ = Seconds{t};
    out.end_ = {from.position + Distance{p}, Velocity{v}, Acceleration{}};
}

void ProfileBuilder::withVelocities(const State& from, const detail::Pieces& pieces,
                                    Profile& out) noexcept {
    double t = 0.0;
    double p = 0.0;
    for (std::size_t i = 0; i < pieces.size; ++i) {
        const double dt = pieces.time[i];
        out.segments_[i] = {Seconds{t},
                            Seconds{dt},
                            {from.position + Distance{p}, Velocity{pieces.value[i]}, {}},
                            Jerk{}};
        t += dt;
        p += dt * pieces.value[i];
    }
    out.size_ = static_cast<std::uint8_t>(pieces.size);
    out.duration_ = Seconds{t};
    out.end_ = {from.position + Distance{p}, {}, {}};
}

void ProfileBuilder::scaled(const Profile& line, double share, const State& from, const State& end,
                            Profile& out) noexcept {
    if (line.size_ == 0) {
        out = Profile::holding(end);
        return;
    }
    const core::Position start = line.segments_[0].from.position;
    for (std::size_t i = 0; i < line.size_; ++i) {
        const Segment& s = line.segments_[i];
        out.segments_[i] = {s.start,
                            s.duration,
                            {from.position + (s.from.position - start) * share,
                             s.from.velocity * share, s.from.acceleration * share},
                            s.jerk * share};
    }
    out.size_ = line.size_;
    out.duration_ = line.duration_;
    out.end_ = end;
}

bool ProfileBuilder::joined(const Profile& first, const Profile& second, Profile& out) noexcept {
    if (first.size_ + second.size_ > Profile::capacity) return false;
    out = first;
    for (std::size_t i = 0; i < second.size_; ++i) {
        Segment segment = second.segments_[i];
        segment.start += first.duration_;
        out.segments_[out.size_++] = segment;
    }
    out.duration_ = first.duration_ + second.duration_;
    out.end_ = second.end_;
    return true;
}

void ProfileBuilder::carried(const Profile& relative, const State& carrier, Profile& out) noexcept {
    const auto moved = [&carrier](const State& s, Seconds time) {
        const Distance way = Distance{carrier.velocity.count() * time.count()};
        return State{carrier.position + Distance{s.position.count()} + way,
                     carrier.velocity + s.velocity, s.acceleration};
    };
    for (std::size_t i = 0; i < relative.size_; ++i) {
        Segment segment = relative.segments_[i];
        segment.from = moved(segment.from, segment.start);
        out.segments_[i] = segment;
    }
    out.size_ = relative.size_;
    out.duration_ = relative.duration_;
    out.end_ = moved(relative.end_, relative.duration_);
}

void ProfileBuilder::setDuration(double duration, Profile& profile) noexcept {
    profile.duration_ = Seconds{duration};
}

void ProfileBuilder::closeOn(const State& end, Profile& profile) noexcept {
    std::size_t longest = 0;
    for (std::size_t i = 1; i < profile.size_; ++i) {
        if (profile.segments_[i].duration > profile.segments_[longest].duration) longest = i;
    }
    double p = 0.0;
    double v = end.velocity.count();
    double a = end.acceleration.count();
    const bool smooth = profile.size_ > 0 && profile.segments_[0].jerk.count() != 0.0;
    for (std::size_t i = profile.size_; smooth && i-- > longest + 1;) {
        Segment& segment = profile.segments_[i];
        const double dt = segment.duration.count();
        const double j = segment.jerk.count();
        p -= dt * (v - dt * (0.5 * a - dt * j * (1.0 / 6.0)));
        v -= dt * (a - 0.5 * dt * j);
        a -= dt * j;
        segment.from = {end.position + Distance{p}, Velocity{v}, Acceleration{a}};
    }
    profile.end_ = end;
}

Profile Profile::holding(State state) noexcept {
    Profile profile;
    profile.end_ = state;
    return profile;
}

namespace {

State advanced(const State& from, double j, double t) noexcept {
    const double v = from.velocity.count();
    const double a = from.acceleration.count();
    return {from.position + Distance{t * (v + t * (0.5 * a + t * j * (1.0 / 6.0)))},
            Velocity{v + t * (a + 0.5 * t * j)}, Acceleration{a + t * j}};
}

}  // namespace

State sample(const Profile& profile, Seconds time) noexcept {
    const double t = time.count();
    const double past = t - profile.duration().count();
    if (past >= 0.0) return past > 0.0 ? advanced(profile.end(), 0.0, past) : profile.end();
    const std::size_t size = profile.size();
    if (size == 0) return profile.end();
    std::size_t i = 0;
    while (i + 1 < size && profile[i + 1].start.count() <= t) ++i;
    const Segment& segment = profile[i];
    const double within = t - segment.start.count();
    return advanced(segment.from, segment.jerk.count(), within > 0.0 ? within : 0.0);
}

}  // namespace takt::planner
