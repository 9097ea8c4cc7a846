#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <takt/wire/al_state.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

#include "dc_unit.hpp"
#include "eeprom.hpp"
#include "event_queue.hpp"
#include "fmmu.hpp"
#include "frame_in_flight.hpp"
#include "sync_managers.hpp"
#include "watchdog.hpp"

namespace takt::twin {

/// How a controller is built into its segment.
struct ControllerSetup {
    double clockPpm{0.0};
    core::Duration clockStart{0};
    bool hasSuccessor{false};  ///< a device hangs on port 1
};

/// What the end of a frame meant for the device application.
struct FrameEvents {
    SyncManagerEvents syncManagers;
    bool alControl{false};  ///< the master has written AL control
};

/// An EtherCAT slave controller chip: registers, process RAM, SyncManagers, FMMUs, DC, EEPROM
/// interface and watchdog, as ETG.1000.4 and the data sheets describe them. Frames are processed
/// when they arrive
/// (`process`, once per datagram) and take effect when they have passed (`commit`).
class SlaveController {
public:
    SlaveController(const wire::DeviceDescription& device, const ControllerSetup& setup,
                    EventPort events);
    SlaveController(const SlaveController&) = delete;
    SlaveController& operator=(const SlaveController&) = delete;

    /// rt. A datagram passes the processing unit.
    void process(Datagram& datagram, core::TrueTime now) noexcept;
    /// rt. The frame has passed with a good check sequence.
    FrameEvents commit(core::TrueTime now) noexcept;
    /// rt. A frame that latches receive times comes back at port 1.
    void latchReturn(core::TrueTime now) noexcept {
        if (dc_) dc_->latchReturn(now, 1);
    }
    /// rt. A frame that is no sound EtherCAT frame was destroyed here.
    void countProcessingError() noexcept;

    // The device application's side.
    /// rt. Reads AL control, which opens it for the next write.
    std::uint16_t takeAlControl() noexcept;
    void setAlStatus(std::uint16_t status, std::uint16_t code) noexcept;
    [[nodiscard]] std::uint16_t alStatus() const noexcept;
    [[nodiscard]] std::uint16_t alStatusCode() const noexcept;
    [[nodiscard]] SyncManagers& syncManagers() noexcept { return syncManagers_; }
    [[nodiscard]] const SyncManagers& syncManagers() const noexcept { return syncManagers_; }
    /// Null when the device has no distributed clock.
    [[nodiscard]] DcUnit* dc() noexcept { return dc_ ? &*dc_ : nullptr; }
    [[nodiscard]] const DcUnit* dc() const noexcept { return dc_ ? &*dc_ : nullptr; }
    [[nodiscard]] ProcessDataWatchdog& watchdog() noexcept { return watchdog_; }
    [[nodiscard]] std::span<const std::uint8_t> registers() const noexcept { return registers_; }
    [[nodiscard]] const std::vector<std::uint8_t>& sii() const noexcept { return eeprom_.image(); }

private:
    static constexpr std::size_t RegisterSpace = 0x1000;
    static constexpr std::size_t PendingBytes = 2048;
    static constexpr std::size_t PendingWrites = 128;

    struct PendingWrite {
        std::uint16_t address{0};
        std::uint16_t length{0};
        std::uint16_t at{0};  ///< in pendingBytes_
    };

    void describeChip(const wire::DeviceDescription& device, const ControllerSetup& setup);
    [[nodiscard]] std::uint16_t eventRequest() const noexcept;
    [[nodiscard]] bool answersTo(std::uint16_t station) const noexcept;

    void readPhysical(Datagram& datagram, bool combine, core::TrueTime now) noexcept;
    void writePhysical(Datagram& datagram, core::TrueTime now) noexcept;
    void exchangePhysical(Datagram& datagram, bool combine, core::TrueTime now) noexcept;
    void processLogical(Datagram& datagram, bool read, bool write, core::TrueTime now) noexcept;

    [[nodiscard]] bool exists(std::size_t address, std::size_t length) const noexcept;
    bool readMemory(std::uint16_t address, std::span<std::uint8_t> data, bool combine,
                    core::TrueTime now) noexcept;
    bool writeMemory(std::uint16_t address, std::span<const std::uint8_t> data,
                     core::TrueTime now) noexcept;
    void readRegisters(std::uint16_t address, std::span<std::uint8_t> data, bool combine,
                       core::TrueTime now) noexcept;
    bool keepForCommit(std::uint16_t address, std::span<const std::uint8_t> data) noexcept;
    bool readMapped(const Fmmu& fmmu, const Overlap& part, std::span<std::uint8_t> data,
                    core::TrueTime now) noexcept;
    bool writeMapped(const Fmmu& fmmu, const Overlap& part, std::span<const std::uint8_t> data,
                     core::TrueTime now) noexcept;

    void applyWrite(std::uint16_t address, std::span<const std::uint8_t> data, core::TrueTime now,
                    FrameEvents& events) noexcept;
    void applyByte(std::uint16_t address, std::uint8_t value) noexcept;
    void applyAlControl(std::uint16_t address, std::span<const std::uint8_t> data,
                        FrameEvents& events) noexcept;

    std::vector<std::uint8_t> registers_;
    std::vector<std::uint8_t> ram_;
    SyncManagers syncManagers_;
    ProcessDataWatchdog watchdog_;
    EepromInterface eeprom_;
    std::optional<DcUnit> dc_;
    std::size_t fmmuCount_;
    FmmuList fmmus_;

    std::array<PendingWrite, PendingWrites> pending_{};
    std::size_t pendingCount_{0};
    std::array<std::uint8_t, PendingBytes> pendingBytes_{};
    std::size_t pendingUsed_{0};
    std::array<std::uint8_t, wire::MaxDatagramData> scratch_{};
};

}  // namespace takt::twin
