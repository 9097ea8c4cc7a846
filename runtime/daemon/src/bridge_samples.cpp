#include "bridge_samples.hpp"

namespace takt::daemon {

namespace {

using fieldbus::ethercat::NetworkState;

template <typename To, typename From>
constexpr To as(From value) noexcept {
    return static_cast<To>(static_cast<std::uint8_t>(value));
}
template <typename To, typename From>
constexpr bool same(To to, From from) noexcept {
    return as<To>(from) == to;
}
// The protocol's numbers are its own; here they happen to be ours.
static_assert(same(bridge::MachinePhase::BringUp, RunPhase::BringUp));
static_assert(same(bridge::MachinePhase::Operating, RunPhase::Operating));
static_assert(same(bridge::MachinePhase::Stopping, RunPhase::PoweringOff));
static_assert(same(bridge::MachinePhase::Over, RunPhase::Over));
static_assert(same(bridge::NetworkState::Off, NetworkState::Off));
static_assert(same(bridge::NetworkState::SafeOp, NetworkState::SafeOp));
static_assert(same(bridge::NetworkState::Op, NetworkState::Op));
static_assert(same(bridge::NetworkState::Failed, NetworkState::Failed));
static_assert(same(bridge::StopCause::Command, StopCause::Command));
static_assert(same(bridge::StopCause::ProgramFault, StopCause::ProgramFault));
static_assert(same(bridge::AxisState::Standstill, axis::AxisState::Standstill));
static_assert(same(bridge::AxisState::SynchronizedMotion, axis::AxisState::SynchronizedMotion));
static_assert(same(bridge::AxisState::ErrorStop, axis::AxisState::ErrorStop));
static_assert(same(bridge::GroupState::Disabled, axis::GroupState::Disabled));
static_assert(same(bridge::GroupState::Moving, axis::GroupState::Moving));
static_assert(same(bridge::GroupState::ErrorStop, axis::GroupState::ErrorStop));

}  // namespace

bridge::MachineSample sampleOf(const RunEntry& run) noexcept {
    return {.cycle = run.cycle,
            .framesSent = run.counters.framesSent,
            .framesLost = run.counters.framesLost,
            .framesLate = run.counters.framesLate,
            .workingCounterErrors = run.counters.workingCounterErrors,
            .phase = as<bridge::MachinePhase>(run.phase),
            .network = as<bridge::NetworkState>(run.network),
            .stop = as<bridge::StopCause>(run.stop.cause)};
}

bridge::AxisSample sampleOf(core::CycleNumber cycle, const axis::AxisStatus& status) noexcept {
    return {.cycle = cycle,
            .set = status.set.count(),
            .setVelocity = status.setVelocity.count(),
            .setAcceleration = status.setAcceleration.count(),
            .actual = status.actual.count(),
            .actualVelocity = status.actualVelocity.count(),
            .lag = status.lag.count(),
            .controlword = status.controlword,
            .statusword = status.statusword,
            .error = static_cast<std::uint16_t>(status.error),
            .driveError = status.driveError,
            .state = as<bridge::AxisState>(status.state),
            .mode = status.mode,
            .powered = status.powered,
            .homed = status.homed};
}

bridge::GroupSample sampleOf(core::CycleNumber cycle, const axis::GroupStatus& status) noexcept {
    return {.cycle = cycle,
            .pathVelocity = status.velocity.count(),
            .error = static_cast<std::uint16_t>(status.error),
            .state = as<bridge::GroupState>(status.state)};
}

}  // namespace takt::daemon
