#pragma once

#include <cstdint>
#include <takt/twin/drive_traits.hpp>
#include <takt/twin/twin_params.hpp>
#include <takt/wire/al_state.hpp>
#include <takt/wire/device_description.hpp>

#include "coe_server.hpp"
#include "drive.hpp"
#include "drive_parameters.hpp"
#include "event_queue.hpp"
#include "mailbox_server.hpp"
#include "object_dictionary.hpp"
#include "pdo_configuration.hpp"
#include "slave_controller.hpp"

namespace takt::twin {

/// The objects that every device of this kind has beside its drive profile.
struct SyncObjects {
    SyncObjects(ObjectDictionary& dictionary, const wire::DeviceDescription& device);

    struct Direction {
        ObjectRef type, cycle, sync0Cycle, missed;
    };
    Direction outputs;  ///< 1C32h
    Direction inputs;   ///< 1C33h
};

/// The software of a simulated device behind its slave controller: AL state machine with its checks
/// (ETG.1000.6 clause 6), mailbox, process data, and the drive.
class SlaveApplication {
public:
    SlaveApplication(const wire::DeviceDescription& device, const TwinDeviceParams& params,
                     core::Duration cycle, SlaveController& controller, EventPort events);
    SlaveApplication(const SlaveApplication&) = delete;
    SlaveApplication& operator=(const SlaveApplication&) = delete;

    /// rt. A frame has passed the controller.
    void onFrame(const FrameEvents& happened, core::TrueTime now) noexcept;
    /// rt. An event of the device is due; SYNC0 has been generated already.
    void onEvent(EventKind kind, core::TrueTime now) noexcept;

    /// rt. An alarm of the drive happens now.
    bool raiseAlarm(std::uint16_t number, core::TrueTime now) noexcept {
        catchUp(now);
        return drive_.raiseAlarm(number);
    }

    [[nodiscard]] const Drive& drive() const noexcept { return drive_; }
    [[nodiscard]] wire::AlState state() const noexcept { return state_; }
    [[nodiscard]] std::uint64_t missedOutputs() const noexcept { return missedTotal_; }
    [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_; }

private:
    struct Places {
        std::size_t mailboxOut{MaxSyncManagers};
        std::size_t mailboxIn{MaxSyncManagers};
        std::size_t outputs{MaxSyncManagers};
        std::size_t inputs{MaxSyncManagers};
    };
    [[nodiscard]] static Places locate(const wire::DeviceDescription& device);

    // slave_states.cpp
    void handleAlControl(core::TrueTime now) noexcept;
    void request(std::uint16_t value, core::TrueTime now) noexcept;
    void enter(wire::AlState next, core::TrueTime now) noexcept;
    void refuse(std::uint16_t code) noexcept;
    void dropToSafeOp(std::uint16_t code, core::TrueTime now) noexcept;
    void waitForOp(core::TrueTime now) noexcept;
    [[nodiscard]] std::uint16_t obstacleToOp() const noexcept;
    [[nodiscard]] std::uint16_t checkMailbox() const noexcept;
    [[nodiscard]] std::uint16_t checkProcessData() noexcept;
    [[nodiscard]] std::uint16_t checkSync() noexcept;
    [[nodiscard]] bool matches(std::size_t sm, bool mailbox, bool masterWrites,
                               std::size_t length) const noexcept;

    // slave_application.cpp
    void period(core::TrueTime now) noexcept;
    void catchUp(core::TrueTime now) noexcept;
    void exchange() noexcept;
    void superviseOutputs(core::TrueTime now) noexcept;
    void tick(core::TrueTime now) noexcept;
    void watchdogExpired(core::TrueTime now) noexcept;
    [[nodiscard]] bool sync0Running() const noexcept;

    const wire::DeviceDescription& device_;
    const DriveTraits& traits_;
    SlaveController& controller_;
    EventPort events_;
    Places places_;
    ObjectDictionary dictionary_;
    SyncObjects syncObjects_;
    PdoConfiguration pdos_;
    Drive drive_;
    DriveParameters parameters_;
    CoeServer coe_;
    MailboxServer mailbox_;

    wire::AlState state_{wire::AlState::Init};
    bool waitingForOp_{false};
    core::TrueTime opDeadline_{};
    core::Duration ownCycle_;  ///< when nothing else sets the pace
    core::Duration cycle_;
    core::TrueTime lastPeriod_{};
    std::uint32_t stepsDone_{0};   ///< of the drive's control steps in this period
    bool outputsReceived_{false};  ///< since SAFEOP was entered
    bool outputsFresh_{false};     ///< since the last period
    std::uint32_t missedInRow_{0};
    std::uint64_t missedTotal_{0};
    std::uint64_t cycles_{0};
};

}  // namespace takt::twin
