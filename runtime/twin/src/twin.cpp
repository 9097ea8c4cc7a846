#include <algorithm>
#include <takt/core/cycle_guard.hpp>
#include <takt/core/random.hpp>
#include <takt/twin/twin.hpp>

#include "local_clock.hpp"
#include "segment.hpp"

namespace takt::twin {

namespace {

/// 0 … largest
core::Duration upTo(core::Random& random, core::Duration largest) noexcept {
    if (largest <= core::Duration{0}) return core::Duration{0};
    return core::Duration{
        static_cast<std::int64_t>(random.upTo(static_cast<std::uint64_t>(largest.count())))};
}

}  // namespace

class Twin::World final : public wire::Link, public core::ClockSource {
public:
    World(const TwinParams& params,
          std::vector<std::shared_ptr<const wire::DeviceDescription>> devices, core::Duration cycle)
        : segment{params, std::move(devices), cycle},
          hostClock_{params.hostPpm, 0},
          wakeJitter_{params.wakeJitter},
          random_{params.seed} {}

    wire::LinkStatus send(std::span<wire::Frame> frames) noexcept override {
        const core::CycleGuardPause notTheController;
        wire::LinkStatus status = wire::LinkStatus::Ok;
        for (wire::Frame& frame : frames) {
            frame.stamp = now();
            if (!segment.launch(frame)) status = wire::LinkStatus::SendFailed;
        }
        return status;
    }

    std::size_t receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept override {
        const core::CycleGuardPause notTheController;
        const core::TrueTime until = trueAt(deadline);
        std::size_t filled = 0;
        while (filled < slots.size()) {
            segment.run(until, true);
            if (!segment.hasArrival()) break;
            wire::Frame& slot = slots[filled++];
            slot.stamp = hostAt(segment.take(slot));
        }
        return filled;
    }

    [[nodiscard]] core::HostTime now() const noexcept override { return hostAt(segment.now()); }

    void sleepUntil(core::HostTime wake) noexcept override {
        const core::CycleGuardPause notTheController;
        if (wake <= now()) return;
        segment.run(trueAt(wake) + upTo(random_, wakeJitter_), false);
    }

    Segment segment;

private:
    [[nodiscard]] core::HostTime hostAt(core::TrueTime time) const noexcept {
        return core::HostTime{core::Duration{hostClock_.at(time)}};
    }
    [[nodiscard]] core::TrueTime trueAt(core::HostTime time) const noexcept {
        return std::max(segment.now(), hostClock_.whenReaching(time.time_since_epoch().count()));
    }

    LocalClock hostClock_;
    core::Duration wakeJitter_;
    core::Random random_;
};

Twin::Twin(const TwinParams& params,
           std::vector<std::shared_ptr<const wire::DeviceDescription>> devices,
           core::Duration cycle)
    : world_{std::make_unique<World>(params, std::move(devices), cycle)} {}

Twin::~Twin() = default;

wire::Link& Twin::link() noexcept {
    return *world_;
}
core::ClockSource& Twin::clock() noexcept {
    return *world_;
}
core::TrueTime Twin::trueTime() const noexcept {
    return world_->segment.now();
}
bool Twin::arrive(const wire::Frame& frame, core::TrueTime arrival) noexcept {
    advance(arrival);
    return world_->segment.launch(frame);
}

std::size_t Twin::comeBack(std::span<wire::Frame> slots) noexcept {
    Segment& segment = world_->segment;
    std::size_t filled = 0;
    while (filled < slots.size()) {
        // Not farther than the last frame: what happens after it waits for the next one.
        segment.run(segment.lastReturn(), true);
        if (!segment.hasArrival()) break;
        segment.take(slots[filled++]);
    }
    return filled;
}

void Twin::advance(core::TrueTime until) noexcept {
    if (until > world_->segment.now()) world_->segment.run(until, false);
}

std::size_t Twin::deviceCount() const noexcept {
    return world_->segment.deviceCount();
}

void Twin::onSync0(std::function<void(std::size_t, core::TrueTime)> observer) {
    world_->segment.onSync0(std::move(observer));
}

void Twin::cutCable(bool cut) noexcept {
    world_->segment.cutCable(cut);
}

bool Twin::raiseAlarm(std::size_t device, std::uint16_t number) noexcept {
    Segment& segment = world_->segment;
    return segment.device(device).application.raiseAlarm(number, segment.now());
}

DeviceProbe Twin::probe(std::size_t device) const {
    const Segment& segment = world_->segment;
    const SimulatedDevice& simulated = segment.device(device);
    DeviceProbe probe;
    probe.alState = simulated.application.state();
    probe.alError = (simulated.controller.alStatus() & wire::AlErrorBit) != 0;
    probe.alStatusCode = simulated.controller.alStatusCode();
    probe.driveState = simulated.application.drive().state();
    probe.motorTurns = simulated.application.drive().motor().position();
    probe.motorVelocity = simulated.application.drive().motor().velocity();
    probe.cycles = simulated.application.cycles();
    probe.missedOutputs = simulated.application.missedOutputs();
    for (std::size_t i = 0; i < segment.deviceCount() && simulated.controller.dc() != nullptr;
         ++i) {
        const DcUnit* reference = segment.device(i).controller.dc();
        if (reference == nullptr) continue;
        probe.clockError = core::Duration{simulated.controller.dc()->syncTime(segment.now()) -
                                          reference->syncTime(segment.now())};
        break;
    }
    return probe;
}

}  // namespace takt::twin
