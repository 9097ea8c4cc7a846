#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <takt/core/time.hpp>
#include <takt/wire/device_description.hpp>

#include "acyclic.hpp"

namespace takt::fieldbus::ethercat {

struct MailboxWords {
    std::uint16_t start{0};
    std::uint16_t size{0};
};

/// What one device on the wire says about itself.
struct ScannedDevice {
    std::uint16_t features{0};
    std::uint8_t fmmus{0};
    std::uint8_t syncManagers{0};
    std::uint16_t dlStatus{0};
    wire::Identity identity{};
    MailboxWords mailboxOut{};  ///< SII words 24, 25: master to device
    MailboxWords mailboxIn{};   ///< SII words 26, 27
    std::uint16_t protocols{0};

    [[nodiscard]] bool has(std::uint16_t feature) const noexcept {
        return (features & feature) != 0;
    }
    /// One bit for each open port: communication established and loop open.
    [[nodiscard]] std::uint8_t openPorts() const noexcept;
};

/// Waits until a device is in INIT, then reads its information registers, its ports and the first
/// words of its EEPROM. One after the other, four bytes at a time: that is what every EEPROM
/// interface can do.
class DeviceScan final : public AcyclicMachine {
public:
    enum class Result : std::uint8_t { Busy, Done, Silent, NotInInit, EepromFailed };

    /// From which state the device may be looked at: bring-up wants it to have arrived in INIT.
    enum class From : std::uint8_t { Init, AnyState };

    explicit DeviceScan(std::uint16_t station, From from = From::Init)
        : station_{station}, phase_{from == From::Init ? Phase::AwaitInit : Phase::Information} {}

    bool next(core::HostTime now, Request& request) noexcept override;
    void take(core::HostTime now, const Reply& reply) noexcept override;
    [[nodiscard]] bool busy() const noexcept override { return result_ == Result::Busy; }

    [[nodiscard]] Result result() const noexcept { return result_; }
    [[nodiscard]] const ScannedDevice& device() const noexcept { return device_; }
    [[nodiscard]] std::uint16_t station() const noexcept { return station_; }

private:
    enum class Phase : std::uint8_t {
        AwaitInit,
        Information,
        Ports,
        EepromIdle,
        ClearErrors,
        Ask,
        Fetch
    };

    void takeEeprom(core::HostTime now, std::span<const std::uint8_t> data) noexcept;
    void keepWords(std::uint32_t words) noexcept;
    void enter(Phase phase, core::HostTime now) noexcept;

    std::uint16_t station_;
    Phase phase_;
    Result result_{Result::Busy};
    std::optional<core::HostTime> deadline_;
    core::HostTime lookAt_{};
    std::size_t wordIndex_{0};
    std::uint8_t silent_{0};
    std::array<std::uint8_t, 6> command_{};
    ScannedDevice device_{};
};

}  // namespace takt::fieldbus::ethercat
