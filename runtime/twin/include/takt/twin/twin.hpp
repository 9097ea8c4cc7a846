#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <takt/core/cia402.hpp>
#include <takt/core/clock_source.hpp>
#include <takt/core/time.hpp>
#include <takt/twin/twin_params.hpp>
#include <takt/wire/al_state.hpp>
#include <takt/wire/device_description.hpp>
#include <takt/wire/link.hpp>
#include <vector>

namespace takt::twin {

/// What a test may see of a simulated device that no master can. Motor values are those of the
/// device's last event.
struct DeviceProbe {
    wire::AlState alState{wire::AlState::None};
    bool alError{false};
    std::uint16_t alStatusCode{0};
    core::cia402::DriveState driveState{core::cia402::DriveState::NotReadyToSwitchOn};
    double motorTurns{0.0};
    double motorVelocity{0.0};       ///< turns/s
    core::Duration clockError{0};    ///< of its SYNC0 time base against the first DC device's, now
    std::uint64_t cycles{0};         ///< SYNC0 pulses, or own cycles without DC
    std::uint64_t missedOutputs{0};  ///< cycles in OP without new outputs
};

/// The simulated machine: an EtherCAT segment with its devices, drives and motors, exact to the
/// frame, and the virtual time of the host that talks to it.
///
///     Twin twin{params, descriptions, cycle};
///     twin.link().send(frames);                          // stamped with host time
///     twin.link().receive(slots, deadline);              // lets the world run until the replies
///     are there twin.clock().sleepUntil(nextBeat);                 // lets the world run until the
///     host wakes up
///
/// Clock and link are two faces of one time, which passes in `receive` and `sleepUntil` only.
/// Everything is deterministic: the same calls give the same bytes. Not thread-safe.
class Twin {
public:
    /// `devices` in frame order, one for each entry of `params.devices`. `cycle`: of the bus.
    /// Throws std::invalid_argument when they do not fit together.
    Twin(const TwinParams& params,
         std::vector<std::shared_ptr<const wire::DeviceDescription>> devices, core::Duration cycle);
    ~Twin();
    Twin(const Twin&) = delete;
    Twin& operator=(const Twin&) = delete;

    /// The host's end of the cable.
    [[nodiscard]] wire::Link& link() noexcept;
    /// The host's own clock: its speed differs from true time, and it wakes up late at random.
    [[nodiscard]] core::ClockSource& clock() noexcept;
    [[nodiscard]] core::TrueTime trueTime() const noexcept;
    [[nodiscard]] std::size_t deviceCount() const noexcept;

    // The door for frames of another process, whose arrival times are given: `takt sim`. Clock and
    // link above are not used with it.

    /// A frame reaches the first device at `arrival`, or now when the world is past it. Lets the
    /// world run until then. \return false when too many frames are under way; it is lost
    bool arrive(const wire::Frame& frame, core::TrueTime arrival) noexcept;
    /// Lets the frames under way come back. \return how many slots were filled, in order of return
    std::size_t comeBack(std::span<wire::Frame> slots) noexcept;
    /// Lets the world run until `until` without a frame: watchdogs end, drives stop.
    void advance(core::TrueTime until) noexcept;

    /// Calls `observer` at every SYNC0 of every device, for tests.
    void onSync0(std::function<void(std::size_t device, core::TrueTime)> observer);
    /// \pre device < deviceCount()
    [[nodiscard]] DeviceProbe probe(std::size_t device) const;
    /// An alarm or warning of a drive happens now, by the number on its display: 8611h for Er.8611,
    /// 600h for E.600. \return false when that drive has no such alarm. \pre device < deviceCount()
    bool raiseAlarm(std::size_t device, std::uint16_t number) noexcept;
    /// Cuts or mends the cable between host and first device.
    void cutCable(bool cut) noexcept;

private:
    class World;
    std::unique_ptr<World> world_;
};

}  // namespace takt::twin
