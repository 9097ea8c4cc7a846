#pragma once

#include <cstdint>
#include <span>
#include <takt/core/time.hpp>

#include "event_queue.hpp"
#include "local_clock.hpp"

namespace takt::twin {

/// The distributed-clock unit of a slave controller (registers 0x0900 to 0x09FF): receive time
/// latches, system time, the control loop that follows the reference clock, and SYNC0.
///
/// It works on the register bytes of its controller; what the master writes arrives there first.
class DcUnit {
public:
    /// `registers` must outlive the unit.
    DcUnit(std::span<std::uint8_t> registers, double ppm, core::Duration start, EventPort events);

    /// rt. The raw local time: the oscillator with the control loop's trim.
    [[nodiscard]] std::int64_t localTime(core::TrueTime now) const noexcept {
        return clock_.at(now);
    }
    /// rt. Local time plus offset: the base of SYNC0.
    [[nodiscard]] std::int64_t syncTime(core::TrueTime now) const noexcept {
        return clock_.at(now) + offset_;
    }
    /// rt. Puts the system time (local + offset - delay) of `now` into 0x0910 for reading.
    void refreshSystemTime(core::TrueTime now) noexcept;
    /// rt. A frame that wrote 0x0900 arrived at port 0; `everyPort`: by a command that latches
    /// 0x0900.
    void latchArrival(core::TrueTime now, bool everyPort) noexcept;
    /// rt. The same frame came back at another port.
    void latchReturn(core::TrueTime now, std::size_t port) noexcept;
    /// rt. A frame that writes 0x0910 arrived; compared at the frame's end.
    void receiveSystemTime(core::TrueTime now, std::uint32_t received) noexcept;
    /// rt. End of a frame: latches become readable and the control loop makes its step.
    void commit(core::TrueTime now) noexcept;
    /// rt. The bytes [address, address + length) have been written by the master.
    void written(std::uint16_t address, std::size_t length, core::TrueTime now) noexcept;
    /// rt. The SYNC0 event is due: generates the pulse and plans the next one.
    void fireSync0(core::TrueTime now) noexcept;

    [[nodiscard]] bool cyclicOn() const noexcept { return active_; }
    /// At least one SYNC0 has been generated since activation.
    [[nodiscard]] bool running() const noexcept { return running_; }
    [[nodiscard]] core::Duration sync0Cycle() const noexcept;

private:
    void resetLoop(core::TrueTime now) noexcept;
    void followReference(core::TrueTime now) noexcept;
    void showDifference() noexcept;
    void activate(core::TrueTime now) noexcept;
    void planSync0() noexcept;

    std::span<std::uint8_t> registers_;
    EventPort events_;
    LocalClock clock_;
    std::int64_t offset_{0};
    std::int64_t delay_{0};

    bool arrivalPending_{false};
    bool arrivalEveryPort_{false};
    std::int64_t arrival_{0};

    bool comparePending_{false};
    std::int32_t difference_{0};    ///< local copy minus received time, ns
    std::int64_t filtered_{0};      ///< difference in 2^-16 ns
    std::int64_t lastCompare_{-1};  ///< local time of the comparison before; -1 = none
    std::int64_t lastInterval_{0};  ///< ns

    bool active_{false};
    bool running_{false};
    std::int64_t nextSync0_{0};
};

}  // namespace takt::twin
