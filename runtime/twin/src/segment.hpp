#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <takt/twin/twin_params.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

#include "event_queue.hpp"
#include "frame_in_flight.hpp"
#include "slave_application.hpp"
#include "slave_controller.hpp"

namespace takt::twin {

/// One simulated device: its controller chip and the software behind it.
struct SimulatedDevice {
    SimulatedDevice(const wire::DeviceDescription& device, const TwinDeviceParams& params,
                    bool hasSuccessor, core::Duration cycle, EventPort events)
        : controller{device, {params.clockPpm, params.clockStart, hasSuccessor}, events},
          application{device, params, cycle, controller, events} {}

    SlaveController controller;
    SlaveApplication application;
};

/// The wire and everything on it, driven by events in true time. Devices form a line behind the
/// host: port 0 towards the host, port 1 towards the next one. Allocates at construction only.
class Segment {
public:
    static constexpr std::size_t MaxFrames = 64;  ///< in flight or waiting to be received

    Segment(const TwinParams& params,
            std::vector<std::shared_ptr<const wire::DeviceDescription>> devices,
            core::Duration cycle);
    Segment(const Segment&) = delete;
    Segment& operator=(const Segment&) = delete;

    [[nodiscard]] core::TrueTime now() const noexcept { return now_; }
    /// rt. Puts a frame on the wire as soon as it is free. \return false when too many are under
    /// way
    bool launch(const wire::Frame& frame) noexcept;
    /// rt. Lets the world run until `until`. `stopAtArrival`: or until a frame has come back.
    void run(core::TrueTime until, bool stopAtArrival) noexcept;

    /// rt. When the last of the frames under way will have come back; now when there is none.
    [[nodiscard]] core::TrueTime lastReturn() const noexcept;

    /// A frame that has come back completely.
    struct Arrival {
        std::size_t slot{0};
        core::TrueTime at{};
    };
    [[nodiscard]] bool hasArrival() const noexcept { return !arrivals_.empty(); }
    /// rt. Copies the oldest arrival into `to`. \pre hasArrival() \return when it arrived
    core::TrueTime take(wire::Frame& to) noexcept;

    [[nodiscard]] std::size_t deviceCount() const noexcept { return devices_.size(); }
    [[nodiscard]] const SimulatedDevice& device(std::size_t i) const noexcept {
        return *devices_[i];
    }
    [[nodiscard]] SimulatedDevice& device(std::size_t i) noexcept { return *devices_[i]; }
    /// While cut, frames leave the host but nothing reaches the devices.
    void cutCable(bool cut) noexcept { cut_ = cut; }
    void onSync0(std::function<void(std::size_t, core::TrueTime)> observer) {
        sync0Observer_ = std::move(observer);
    }

private:
    /// A frame's way: arrival at each device, end at each device, return at port 1 of each, the
    /// host.
    struct Journey {
        std::size_t slot{0};
        core::TrueTime start{};
        core::Duration length{0};  ///< first to last bit
        std::size_t entered{0};    ///< devices that have processed it
        std::size_t passed{0};     ///< devices at which it has ended
        std::size_t returning{0};  ///< devices whose port 1 still waits for it; 0 unless latching
        core::TrueTime next{};
    };

    void layOut(const TwinParams& params);
    void planNext(Journey& journey) const noexcept;
    void step(std::size_t which) noexcept;
    void enter(Journey& journey) noexcept;
    void finish(std::size_t which) noexcept;
    void fire() noexcept;
    [[nodiscard]] std::size_t freeSlot() noexcept;

    EventQueue events_;
    std::vector<std::shared_ptr<const wire::DeviceDescription>> descriptions_;
    std::vector<std::unique_ptr<SimulatedDevice>> devices_;
    std::vector<core::Duration> inbound_;   ///< start of frame at port 0, after leaving the host
    std::vector<core::Duration> outbound_;  ///< the same frame back at port 1
    core::Duration roundTrip_{0};

    std::vector<FrameInFlight> frames_;
    std::array<bool, MaxFrames> used_{};
    std::vector<Journey> journeys_;  ///< in order of launch; capacity MaxFrames
    std::vector<Arrival> arrivals_;  ///< oldest first; capacity MaxFrames
    core::TrueTime now_{};
    core::TrueTime wireFree_{};
    bool cut_{false};
    std::function<void(std::size_t, core::TrueTime)> sync0Observer_;
};

}  // namespace takt::twin
