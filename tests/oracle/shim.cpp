#include <array>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <takt/planner/trajectory.hpp>

#include "otg.h"

#define TAKT_EXPORT __attribute__((visibility("default")))

namespace {

using namespace takt;

struct Handle {
    explicit Handle(std::size_t axes) : trajectory{axes} {}

    planner::Trajectory trajectory;
    std::array<planner::AxisRequest, planner::Trajectory::maxAxes> requests{};
    std::array<planner::State, planner::Trajectory::maxAxes> states{};
};

/// Answers of this interface are judged to 1e-8 of SI units, and a generator that is that coarse
/// inside calls anything nearer "arrived". Asking for a nanometre keeps durations comparable.
constexpr double kResolution = 1e-9;

planner::Limits limitsOf(const otg_problem& q, std::size_t i) {
    const double inf = std::numeric_limits<double>::infinity();
    const bool toVelocity = (q.flags & OTG_VELOCITY) != 0;
    return {core::Velocity{toVelocity ? inf : q.vmax[i]},
            core::Velocity{toVelocity ? -inf : q.vmin[i]}, core::Acceleration{q.amax[i]},
            core::Acceleration{q.amin[i]},
            core::Jerk{(q.flags & OTG_SECOND) != 0 ? inf : q.jmax[i]}};
}

void fill(const otg_problem& q, std::span<planner::AxisRequest> requests) {
    const auto kind =
        (q.flags & OTG_VELOCITY) != 0 ? planner::TargetKind::Velocity : planner::TargetKind::State;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const double pf = kind == planner::TargetKind::Velocity ? q.p0[i] : q.pf[i];
        requests[i].from = {core::Position{q.p0[i]}, core::Velocity{q.v0[i]},
                            core::Acceleration{q.a0[i]}};
        requests[i].target = {
            kind, {core::Position{pf}, core::Velocity{q.vf[i]}, core::Acceleration{q.af[i]}}};
        requests[i].limits = limitsOf(q, i);
        requests[i].resolution = {core::Distance{kResolution}, core::Velocity{kResolution}};
    }
}

planner::Timing timingOf(const otg_problem& q) {
    planner::Timing timing;
    if ((q.flags & OTG_NO_SYNC) != 0) {
        timing.synchronisation = planner::Synchronisation::None;
    } else if ((q.flags & OTG_PHASE) != 0) {
        timing.synchronisation = planner::Synchronisation::Phase;
    }
    if ((q.flags & OTG_DISCRETE) != 0) timing.cycle = core::Seconds{q.cycle};
    timing.minDuration = core::Seconds{q.min_duration};
    return timing;
}

}  // namespace

extern "C" {

TAKT_EXPORT uint32_t otg_abi_version(void) {
    return OTG_VERSION;
}

TAKT_EXPORT const char* otg_name(void) {
    return "takt";
}

TAKT_EXPORT void* otg_open(uint32_t dofs, double /*cycle*/) {
    if (dofs < 1 || dofs > planner::Trajectory::maxAxes) return nullptr;
    return new (std::nothrow) Handle{dofs};
}

TAKT_EXPORT int32_t otg_solve(void* handle, const otg_problem* problem, double* duration) {
    Handle& h = *static_cast<Handle*>(handle);
    if (problem->dofs != h.trajectory.size()) return -1;
    const std::span<planner::AxisRequest> requests{h.requests.data(), h.trajectory.size()};
    fill(*problem, requests);
    const auto result = h.trajectory.plan(requests, timingOf(*problem));
    if (!result.ok()) return 1 + static_cast<int32_t>(result.error().error);
    *duration = result.value().count();
    return 0;
}

TAKT_EXPORT void otg_sample(void* handle, double t, double* p, double* v, double* a) {
    Handle& h = *static_cast<Handle*>(handle);
    h.trajectory.sample(core::Seconds{t}, h.states);
    for (std::size_t i = 0; i < h.trajectory.size(); ++i) {
        p[i] = h.states[i].position.count();
        v[i] = h.states[i].velocity.count();
        a[i] = h.states[i].acceleration.count();
    }
}

TAKT_EXPORT uint32_t otg_segments(void* handle, uint32_t dof, otg_segment* out) {
    const Handle& h = *static_cast<Handle*>(handle);
    const planner::Profile& profile = h.trajectory[dof];
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const planner::Segment& s = profile[i];
        out[i] = {s.duration.count(), s.from.acceleration.count(), s.jerk.count()};
    }
    return static_cast<uint32_t>(profile.size());
}

TAKT_EXPORT void otg_close(void* handle) {
    delete static_cast<Handle*>(handle);
}

}  // extern "C"
