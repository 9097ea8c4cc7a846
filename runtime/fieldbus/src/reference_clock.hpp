#pragma once

#include <cstdint>
#include <optional>
#include <takt/core/time.hpp>
#include <takt/fieldbus/ethercat/dc_sample.hpp>

#include "cycle_plan.hpp"
#include "dc_line.hpp"
#include "frame_set.hpp"

namespace takt::fieldbus::ethercat {

/// The first DC device: its time is read and handed on to the others by one FRMW per cycle, and the
/// host learns from it where it stands on the SYNC0 grid.
class ReferenceClock {
public:
    ReferenceClock(core::Duration cycle, core::Duration sync0AfterSend)
        : cycle_{cycle}, sync0AfterSend_{sync0AfterSend} {}

    /// The device whose clock leads, once it is known. A datagram of four bytes carries the low
    /// half of its time only.
    void lead(std::uint16_t station, bool wide,
              const PlannedDatagram& datagram = standard()) noexcept;
    void forget() noexcept;
    [[nodiscard]] bool present() const noexcept { return station_ != 0; }

    /// rt. Appends the datagram of register 0x0910, FRMW unless listed otherwise. \pre present()
    void append(FrameSet& frames) noexcept;
    /// rt. Devices before the reference are written with what is sent: puts in the best guess.
    void fill(FrameSet& frames) const noexcept;
    /// rt. Takes its reply.
    void take(const FrameSet& frames) noexcept;
    [[nodiscard]] const DcSample& sample() const noexcept { return sample_; }
    /// Reference time at a reading of the host's clock, from the last exchange. \pre a reply was
    /// taken
    [[nodiscard]] core::DcTime at(core::HostTime host) const noexcept;
    /// A host time at or after `notBefore` at which a frame sits on the grid; without a reference
    /// clock a multiple of the cycle.
    [[nodiscard]] core::HostTime gridSend(core::HostTime notBefore) const noexcept;

private:
    [[nodiscard]] static const PlannedDatagram& standard() noexcept;

    core::Duration cycle_;
    core::Duration sync0AfterSend_;
    std::uint16_t station_{0};
    wire::Command command_{wire::Command::Frmw};
    std::uint16_t address_{0};  ///< station, or position for ARMW
    std::uint16_t length_{8};
    bool wide_{true};  ///< 64-bit; else the high half is carried on by the host
    DatagramId datagram_{0};
    DcSample sample_{};
    core::Duration dcMinusHost_{DcEpoch};
};

}  // namespace takt::fieldbus::ethercat
