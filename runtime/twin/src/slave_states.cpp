// The AL state machine of a simulated device (ETG.1000.6 clause 6.4) and what it checks on each
// transition.

#include "slave_application.hpp"

namespace takt::twin {

namespace alcode = wire::alcode;
namespace reg = wire::reg;
using wire::AlState;

namespace {

// How long a drive waits in SAFEOP for outputs and SYNC0 before it gives up the way to OP.
constexpr core::Duration OpPatience = std::chrono::milliseconds{200};
// The clock must agree with the reference before the drive lets itself be paced by SYNC0.
constexpr std::uint32_t LockLimit = 10'000;  // ns
constexpr std::uint32_t DifferenceMask = 0x7FFFFFFF;
constexpr std::uint8_t CyclicOperation = 0x01;
constexpr std::int64_t FreeRun = 0;
constexpr std::int64_t DcSync0 = 2;

bool isState(std::uint16_t value) noexcept {
    switch (static_cast<AlState>(value)) {
        case AlState::Init:
        case AlState::PreOp:
        case AlState::Boot:
        case AlState::SafeOp:
        case AlState::Op:
            return true;
        case AlState::None:
            break;
    }
    return false;
}

/// ETG.1000.6 table 102, without BOOT.
bool isTransition(AlState from, AlState to) noexcept {
    switch (from) {
        case AlState::Init:
            return to == AlState::PreOp;
        case AlState::PreOp:
            return to == AlState::Init || to == AlState::SafeOp;
        case AlState::SafeOp:
        case AlState::Op:
            return to != AlState::Boot;
        case AlState::None:
        case AlState::Boot:
            break;
    }
    return false;
}

}  // namespace

void SlaveApplication::handleAlControl(core::TrueTime now) noexcept {
    catchUp(now);
    const std::uint16_t control = controller_.takeAlControl();
    const auto requested = static_cast<std::uint16_t>(control & wire::AlStateMask);
    const bool error = (controller_.alStatus() & wire::AlErrorBit) != 0;
    const bool acknowledged = (control & wire::AlErrorBit) != 0;
    // Without acknowledgement an error keeps the device where it is; only INIT is always open.
    if (error && !acknowledged && requested != static_cast<std::uint16_t>(AlState::Init)) return;
    if (acknowledged) controller_.setAlStatus(static_cast<std::uint16_t>(state_), alcode::NoError);
    waitingForOp_ = false;
    request(requested, now);
}

void SlaveApplication::request(std::uint16_t value, core::TrueTime now) noexcept {
    if (!isState(value)) return refuse(alcode::UnknownState);
    const auto wanted = static_cast<AlState>(value);
    if (wanted == state_) return enter(wanted, now);
    if (wanted == AlState::Boot && state_ == AlState::Init) return refuse(alcode::BootNotSupported);
    if (!isTransition(state_, wanted)) return refuse(alcode::InvalidStateChange);
    if (value < static_cast<std::uint16_t>(state_)) return enter(wanted, now);

    std::uint16_t obstacle = alcode::NoError;
    if (wanted == AlState::PreOp) obstacle = checkMailbox();
    if (wanted == AlState::SafeOp) obstacle = checkProcessData();
    if (wanted == AlState::Op) {
        waitingForOp_ = true;
        opDeadline_ = now + OpPatience;
        waitForOp(now);
        return;
    }
    if (obstacle != alcode::NoError) return refuse(obstacle);
    enter(wanted, now);
}

void SlaveApplication::enter(AlState next, core::TrueTime now) noexcept {
    const AlState before = state_;
    state_ = next;
    waitingForOp_ = false;
    controller_.setAlStatus(static_cast<std::uint16_t>(next), alcode::NoError);
    if (before == next) return;
    if (next == AlState::Init || before == AlState::Init) mailbox_.reset();
    if (next == AlState::Op) {
        missedInRow_ = 0;
        outputsFresh_ = true;  // the outputs that opened the way to OP are valid now
    }
    if (next == AlState::SafeOp && before == AlState::PreOp) {
        outputsReceived_ = false;
        cycle_ = controller_.dc() != nullptr && controller_.dc()->cyclicOn()
                     ? controller_.dc()->sync0Cycle()
                     : ownCycle_;
        drive_.setCycle(cycle_);
        stepsDone_ = 0;
        lastPeriod_ = now;
        exchange();  // inputs are valid from the first moment of SAFEOP
    }
}

void SlaveApplication::refuse(std::uint16_t code) noexcept {
    waitingForOp_ = false;
    controller_.setAlStatus(
        static_cast<std::uint16_t>(static_cast<std::uint16_t>(state_) | wire::AlErrorBit), code);
}

void SlaveApplication::dropToSafeOp(std::uint16_t code, core::TrueTime now) noexcept {
    enter(AlState::SafeOp, now);
    refuse(code);
}

void SlaveApplication::waitForOp(core::TrueTime now) noexcept {
    const std::uint16_t obstacle = obstacleToOp();
    if (obstacle == alcode::NoError) {
        enter(AlState::Op, now);
    } else if (now >= opDeadline_) {
        refuse(obstacle);
    }
}

std::uint16_t SlaveApplication::obstacleToOp() const noexcept {
    const DcUnit* dc = controller_.dc();
    if (dc != nullptr && dc->cyclicOn()) {
        if (!dc->running()) return alcode::NoSyncError;
        const std::uint32_t difference =
            wire::load32(controller_.registers(), reg::DcSystemTimeDifference) & DifferenceMask;
        if (difference > LockLimit) return alcode::PllError;
    }
    const bool needsOutputs = pdos_.size(PdoDirection::ToDevice) != 0;
    return needsOutputs && !outputsReceived_ ? alcode::NoValidOutputs : alcode::NoError;
}

bool SlaveApplication::matches(std::size_t sm, bool mailbox, bool masterWrites,
                               std::size_t length) const noexcept {
    if (sm >= device_.syncManagers.size()) return length == 0;
    const SyncManagers& managers = controller_.syncManagers();
    if (length == 0) return true;
    return managers.enabled(sm) && managers.mailbox(sm) == mailbox &&
           managers.masterWrites(sm) == masterWrites &&
           managers.start(sm) == device_.syncManagers[sm].start && managers.length(sm) == length;
}

std::uint16_t SlaveApplication::checkMailbox() const noexcept {
    if (!device_.mailbox) return alcode::NoError;
    for (const std::size_t sm : {places_.mailboxOut, places_.mailboxIn}) {
        if (sm >= device_.syncManagers.size()) return alcode::InvalidMailboxPreOp;
        const wire::SyncManagerDescription& own = device_.syncManagers[sm];
        const std::size_t length = controller_.syncManagers().length(sm);
        // A range is offered only where the description names one.
        const bool sizeAllowed = own.maxSize > own.minSize
                                     ? length >= own.minSize && length <= own.maxSize
                                     : length == own.defaultSize;
        if (!sizeAllowed || length == 0 || !matches(sm, true, sm == places_.mailboxOut, length)) {
            return alcode::InvalidMailboxPreOp;
        }
    }
    return alcode::NoError;
}

std::uint16_t SlaveApplication::checkProcessData() noexcept {
    if (!pdos_.resolve(PdoDirection::ToDevice)) return alcode::InvalidOutputMapping;
    if (!pdos_.resolve(PdoDirection::FromDevice)) return alcode::InvalidInputMapping;
    if (!matches(places_.outputs, false, true, pdos_.size(PdoDirection::ToDevice))) {
        return alcode::InvalidOutputConfiguration;
    }
    if (!matches(places_.inputs, false, false, pdos_.size(PdoDirection::FromDevice))) {
        return alcode::InvalidInputConfiguration;
    }
    return checkSync();
}

std::uint16_t SlaveApplication::checkSync() noexcept {
    const DcUnit* dc = controller_.dc();
    const bool wanted =
        dc != nullptr && (controller_.registers()[reg::DcActivation] & CyclicOperation) != 0;
    if (wanted && !dc->cyclicOn()) return alcode::InvalidDcSync;
    if (wanted && !traits_.allowsCycle(dc->sync0Cycle())) return alcode::InvalidSync0Cycle;
    const std::int64_t sync0 = wanted ? dc->sync0Cycle().count() : 0;
    for (const SyncObjects::Direction* refs : {&syncObjects_.outputs, &syncObjects_.inputs}) {
        dictionary_.set(refs->sync0Cycle, sync0);
        const std::int64_t type = dictionary_.getSigned(syncObjects_.outputs.type);
        // The sync type follows what the master has set up in the controller's DC unit.
        if (wanted) {
            dictionary_.set(refs->cycle, sync0);
            dictionary_.set(refs->type, DcSync0);
        } else if (type == DcSync0 && traits_.lockFollowsSyncType) {
            dictionary_.set(refs->type, FreeRun);
        }
    }
    return alcode::NoError;
}

}  // namespace takt::twin
