#include "slave_application.hpp"

#include <algorithm>

namespace takt::twin {

using wire::AlState;
using wire::DataType;

namespace {

// What a drive's communication processor takes to look at its mailbox, and to work through AL
// control.
constexpr core::Duration MailboxDelay = std::chrono::microseconds{700};
constexpr std::uint16_t SyncTypeDcSync0 = 2;

core::Duration alDelay(std::uint16_t requested) noexcept {
    using std::chrono::milliseconds;
    switch (static_cast<AlState>(requested & wire::AlStateMask)) {
        case AlState::PreOp:
            return milliseconds{2};
        case AlState::SafeOp:
            return milliseconds{3};
        case AlState::None:
        case AlState::Init:
        case AlState::Boot:
        case AlState::Op:
            break;
    }
    return milliseconds{1};
}

DictionaryEntry visible(std::uint16_t index, std::uint8_t subindex, DataType type, bool writable) {
    DictionaryEntry entry;
    entry.index = index;
    entry.subindex = subindex;
    entry.type = type;
    entry.writable = writable;
    return entry;
}

}  // namespace

SyncObjects::SyncObjects(ObjectDictionary& dictionary, const wire::DeviceDescription& device) {
    const auto fixed = [&](std::uint16_t index, std::uint8_t subindex, DataType type,
                           std::int64_t value) {
        return dictionary.ensure(visible(index, subindex, type, false), value);
    };
    fixed(0x1000, 0, DataType::Unsigned32, 0x00020192);
    fixed(0x1001, 0, DataType::Unsigned8, 0);
    fixed(0x1018, 0, DataType::Unsigned8, 4);
    // The identity that the SII shows, whatever the dictionary's defaults say.
    const std::uint32_t identity[] = {device.identity.vendor, device.identity.product,
                                      device.identity.revision, device.identity.serial};
    for (std::uint8_t i = 0; i < 4; ++i) {
        dictionary.set(fixed(0x1018, static_cast<std::uint8_t>(i + 1), DataType::Unsigned32, 0),
                       identity[i]);
    }
    fixed(0x1C00, 0, DataType::Unsigned8, static_cast<std::int64_t>(device.syncManagers.size()));
    for (std::size_t i = 0; i < device.syncManagers.size(); ++i) {
        fixed(0x1C00, static_cast<std::uint8_t>(i + 1), DataType::Unsigned8,
              static_cast<std::int64_t>(device.syncManagers[i].use));
    }
    const auto direction = [&](std::uint16_t index) {
        fixed(index, 0, DataType::Unsigned8, 0x20);
        Direction refs;
        refs.type = dictionary.ensure(visible(index, 1, DataType::Unsigned16, true), 0);
        refs.cycle = dictionary.ensure(visible(index, 2, DataType::Unsigned32, true), 0);
        fixed(index, 4, DataType::Unsigned16, 0x0007);
        fixed(index, 5, DataType::Unsigned32, 125000);
        refs.sync0Cycle = fixed(index, 0x0A, DataType::Unsigned32, 0);
        refs.missed = fixed(index, 0x0B, DataType::Unsigned16, 0);
        return refs;
    };
    outputs = direction(0x1C32);
    inputs = direction(0x1C33);
}

SlaveApplication::Places SlaveApplication::locate(const wire::DeviceDescription& device) {
    Places places;
    for (std::size_t i = 0; i < device.syncManagers.size() && i < MaxSyncManagers; ++i) {
        switch (device.syncManagers[i].use) {
            case wire::SyncManagerUse::Unused:
                break;
            case wire::SyncManagerUse::MailboxOut:
                places.mailboxOut = i;
                break;
            case wire::SyncManagerUse::MailboxIn:
                places.mailboxIn = i;
                break;
            case wire::SyncManagerUse::Outputs:
                places.outputs = i;
                break;
            case wire::SyncManagerUse::Inputs:
                places.inputs = i;
                break;
        }
    }
    return places;
}

SlaveApplication::SlaveApplication(const wire::DeviceDescription& device,
                                   const TwinDeviceParams& params, core::Duration cycle,
                                   SlaveController& controller, EventPort events)
    : device_{device},
      traits_{driveTraits(params.profile)},
      controller_{controller},
      events_{events},
      places_{locate(device)},
      dictionary_{device},
      syncObjects_{dictionary_, device},
      pdos_{device, traits_, dictionary_},
      coe_{traits_, dictionary_, pdos_, device.mailbox && device.mailbox->completeAccess},
      mailbox_{controller.syncManagers(), coe_, places_.mailboxOut, places_.mailboxIn},
      drive_{params, traits_, dictionary_, cycle},
      ownCycle_{cycle},
      cycle_{cycle} {
    events_.schedule(EventKind::Tick, core::TrueTime{cycle});
}

void SlaveApplication::onFrame(const FrameEvents& happened, core::TrueTime now) noexcept {
    const auto bit = [](std::size_t sm) { return sm < MaxSyncManagers ? 1U << sm : 0U; };
    if ((happened.syncManagers.written & bit(places_.outputs)) != 0) {
        outputsFresh_ = true;
        outputsReceived_ = true;
    }
    if (happened.alControl) {
        const auto requested = wire::load16(controller_.registers(), wire::reg::AlControl);
        events_.schedule(EventKind::AlControl, now + alDelay(requested));
    }
    if (state_ == AlState::Init) return;
    if ((happened.syncManagers.written & bit(places_.mailboxOut)) != 0) {
        events_.schedule(EventKind::Mailbox, now + MailboxDelay);
    }
    if ((happened.syncManagers.taken & bit(places_.mailboxIn)) != 0) mailbox_.answerTaken();
    if ((happened.syncManagers.repeated & bit(places_.mailboxIn)) != 0) mailbox_.repeatLast();
}

void SlaveApplication::onEvent(EventKind kind, core::TrueTime now) noexcept {
    switch (kind) {
        case EventKind::Sync0:
            period(now);
            break;
        case EventKind::Watchdog:
            if (controller_.watchdog().fire(now)) watchdogExpired(now);
            break;
        case EventKind::AlControl:
            handleAlControl(now);
            break;
        case EventKind::Mailbox:
            catchUp(now);  // what an SDO reads and writes belongs to this instant
            mailbox_.serve(state_);
            break;
        case EventKind::Tick:
            tick(now);
            break;
    }
}

bool SlaveApplication::sync0Running() const noexcept {
    return controller_.dc() != nullptr && controller_.dc()->running();
}

void SlaveApplication::tick(core::TrueTime now) noexcept {
    // While SYNC0 sets the pace this event only watches that it does.
    const core::TrueTime due = lastPeriod_ + (sync0Running() ? 2 * cycle_ : cycle_);
    if (now < due) {
        events_.schedule(EventKind::Tick, due);
        return;
    }
    if (state_ == AlState::Op &&
        dictionary_.getUnsigned(syncObjects_.outputs.type) == SyncTypeDcSync0) {
        dropToSafeOp(wire::alcode::FatalSyncError, now);
    }
    period(now);
    events_.schedule(EventKind::Tick, now + cycle_);
}

void SlaveApplication::catchUp(core::TrueTime now) noexcept {
    // Control steps run when somebody needs their result; the outcome is that of running each in
    // time.
    const std::int64_t stepTime = cycle_.count() / drive_.subSteps();
    const auto due = static_cast<std::uint32_t>(std::min<std::int64_t>(
        (now - lastPeriod_).count() / std::max<std::int64_t>(1, stepTime), drive_.subSteps()));
    if (due <= stepsDone_) return;
    drive_.advance(due - stepsDone_);
    stepsDone_ = due;
}

void SlaveApplication::period(core::TrueTime now) noexcept {
    drive_.advance(drive_.subSteps() - std::min(stepsDone_, drive_.subSteps()));
    stepsDone_ = 0;
    lastPeriod_ = now;
    ++cycles_;
    if (waitingForOp_) waitForOp(now);
    if (state_ == AlState::Op) superviseOutputs(now);
    exchange();
    if (const auto emergency = drive_.takeEmergency()) {
        if (state_ != AlState::Init && places_.mailboxIn < MaxSyncManagers)
            mailbox_.send(*emergency);
    }
}

void SlaveApplication::superviseOutputs(core::TrueTime now) noexcept {
    if (outputsFresh_ || pdos_.size(PdoDirection::ToDevice) == 0) {
        missedInRow_ = 0;
        return;
    }
    ++missedInRow_;
    ++missedTotal_;
    dictionary_.set(syncObjects_.outputs.missed, static_cast<std::int64_t>(missedTotal_));
    if (traits_.lostTargetLimit == 0 || missedInRow_ < traits_.lostTargetLimit) return;
    drive_.communicationLost();
    dropToSafeOp(wire::alcode::SynchronizationError, now);
}

void SlaveApplication::exchange() noexcept {
    SyncManagers& managers = controller_.syncManagers();
    const bool op = state_ == AlState::Op;
    if (op && outputsFresh_) {
        const auto data = managers.newest(places_.outputs);
        if (!data.empty()) pdos_.takeOutputs(data);
    }
    outputsFresh_ = false;
    drive_.cycle(op, sync0Running());
    if (!op && state_ != AlState::SafeOp) return;
    if (pdos_.size(PdoDirection::FromDevice) == 0) return;
    pdos_.putInputs(managers.nextBuffer(places_.inputs));
    managers.publish(places_.inputs);
}

void SlaveApplication::watchdogExpired(core::TrueTime now) noexcept {
    if (state_ != AlState::Op) return;
    catchUp(now);
    drive_.communicationLost();
    dropToSafeOp(wire::alcode::SyncManagerWatchdog, now);
}

}  // namespace takt::twin
