#include "slave_agent.hpp"

#include <takt/wire/byte_io.hpp>
#include <takt/wire/device_description.hpp>
#include <takt/wire/registers.hpp>

namespace takt::fieldbus::ethercat {

namespace {

namespace reg = wire::reg;

constexpr std::uint8_t RegisterTries = 5;
constexpr std::uint8_t ReadTries = 3;
constexpr std::uint32_t DifferenceMask = 0x7FFF'FFFF;  ///< sign-magnitude: the sign is for display
constexpr std::uint32_t NoDictionary = 0x0800'0023;

}  // namespace

SlaveAgent::SlaveAgent(const SlaveParams& params, std::uint16_t station, WorkSet& work,
                       std::size_t number)
    : params_{params}, station_{station}, work_{work}, number_{number} {
    const std::optional<MailboxPlace> place = mailboxPlace(params);
    if (place && params.device->mailbox->coe) coe_.emplace(*place, *params.device->mailbox);
}

void SlaveAgent::run(const Script& script) noexcept {
    script_ = &script;
    position_ = 0;
    stepStarted_ = false;
    registerTries_ = 0;
    failure_ = {};
    scriptState_ = script.empty() ? ScriptState::Done : ScriptState::Running;
    if (scriptState_ == ScriptState::Running) wake();
}

const Step* SlaveAgent::failedStep() const noexcept {
    return scriptState_ == ScriptState::Failed ? &(*script_)[position_] : nullptr;
}

void SlaveAgent::reset() noexcept {
    if (coe_) coe_->client.reset();
    if (asking_ != nullptr)
        asking_->end({core::ObjectState::Failed, {}, wire::abortcode::WrongDeviceState});
    asking_ = nullptr;
    statusWanted_ = differenceWanted_ = false;
    difference_.reset();
    al_ = {};
    answers_ = true;
    scriptState_ = ScriptState::Idle;
    notes_.clear();
}

void SlaveAgent::wantStatus() noexcept {
    if (statusWanted_) return;
    statusWanted_ = true;
    statusTries_ = 0;
    wake();
}

void SlaveAgent::wantDifference() noexcept {
    if (differenceWanted_) return;
    differenceWanted_ = true;
    differenceTries_ = 0;
    wake();
}

void SlaveAgent::mailboxFull() noexcept {
    if (!coe_) return;
    coe_->mailbox.fetch();
    wake();
}

void SlaveAgent::lookIntoMailbox() noexcept {
    if (!coe_) return;
    coe_->mailbox.look();
    wake();
}

const EmergencyRecord& SlaveAgent::lastEmergency() const noexcept {
    static constexpr EmergencyRecord none{};
    return coe_ ? coe_->client.lastEmergency() : none;
}

std::uint32_t SlaveAgent::emergencies() const noexcept {
    return coe_ ? coe_->client.emergencies() : 0;
}

bool SlaveAgent::busy() const noexcept {
    return statusWanted_ || differenceWanted_ || scriptState_ == ScriptState::Running ||
           (coe_ && (coe_->mailbox.busy() || coe_->client.pending()));
}

// --- one datagram at a time
// ------------------------------------------------------------------------

bool SlaveAgent::next(core::HostTime now, Request& request) noexcept {
    job_ = Job::None;
    if (statusWanted_) {
        job_ = Job::Status;
        request = readRequest(station_, reg::AlStatus, AlReadingBytes);
        return true;
    }
    if (differenceWanted_) {
        job_ = Job::Difference;
        request = readRequest(station_, reg::DcSystemTimeDifference, 4);
        return true;
    }
    if (scriptState_ == ScriptState::Running && nextOfScript(now, request)) return true;
    return nextOfMailbox(now, request);
}

bool SlaveAgent::nextOfScript(core::HostTime now, Request& request) noexcept {
    const Step& step = (*script_)[position_];
    if (const auto* write = std::get_if<RegisterStep>(&step)) {
        job_ = Job::Register;
        request = writeRequest(station_, write->address, write->data);
        return true;
    }
    if (const auto* state = std::get_if<StateStep>(&step)) {
        if (!stepStarted_) {
            // The mailbox starts afresh on the way up from INIT (ETG.1000.4 clause 6.6.5).
            if (state->target == wire::AlState::PreOp && al_.state <= wire::AlState::Init && coe_) {
                coe_->client.reset();
            }
            walker_.start(state->target, state->timeout);
            stepStarted_ = true;
        }
        job_ = Job::Walk;
        if (walker_.next(now, station_, request)) return true;
        endStateStep();
        return false;
    }
    if (const auto* listed = std::get_if<CommandStep>(&step)) {
        if (!stepStarted_) startCommandStep(*listed);
        job_ = Job::Command;
        if (runner_.next(now, request)) return true;
        endCommandStep(listed->command);
        return false;
    }
    if (const auto* object = std::get_if<ObjectStep>(&step)) startObjectStep(*object);
    return false;  // the mailbox has the next datagram
}

void SlaveAgent::startObjectStep(const ObjectStep& step) noexcept {
    if (stepStarted_) return;
    if (coe_) {
        stepStarted_ = coe_->client.startWrite(
            step.address, std::span{step.data},
            step.completeAccess ? CoeClient::Access::Whole : CoeClient::Access::OneEntry);
    } else {
        fail({ScriptFailure::Kind::ObjectAborted, step.address.index, step.address.subindex,
              NoDictionary, wire::AlState::None, al_});
    }
}

bool SlaveAgent::nextOfMailbox(core::HostTime now, Request& request) noexcept {
    if (!coe_) return false;
    coe_->client.watch(now);
    afterMailbox();
    job_ = Job::Mailbox;
    return coe_->mailbox.next(now, station_, request);
}

void SlaveAgent::take(core::HostTime now, const Reply& reply) noexcept {
    switch (job_) {
        case Job::None:
            break;
        case Job::Status:
            takeStatus(reply);
            break;
        case Job::Difference:
            takeDifference(reply);
            break;
        case Job::Walk:
            walker_.take(now, reply);
            if (walker_.seen().state != wire::AlState::None) al_ = walker_.seen();
            endStateStep();
            break;
        case Job::Register:
            takeRegister(reply);
            break;
        case Job::Command:
            takeCommand(now, reply);
            break;
        case Job::Mailbox: {
            MailboxMessage message;
            if (coe_->mailbox.take(now, reply, message)) coe_->client.take(message);
            afterMailbox();
            break;
        }
    }
}

// --- listed commands
// ------------------------------------------------------------------------------

void SlaveAgent::startCommandStep(const CommandStep& step) noexcept {
    const ListedCommand& command = step.command;
    const bool asksForPreOp =
        writes(command) && command.ado == reg::AlControl && !command.data.empty() &&
        (command.data[0] & wire::AlStateMask) == static_cast<std::uint8_t>(wire::AlState::PreOp);
    if (asksForPreOp && al_.state <= wire::AlState::Init && coe_) coe_->client.reset();
    runner_.start(command);
    stepStarted_ = true;
}

void SlaveAgent::takeCommand(core::HostTime now, const Reply& reply) noexcept {
    const auto* step = std::get_if<CommandStep>(&(*script_)[position_]);
    if (step == nullptr) return;
    runner_.take(now, reply);
    if (reply.served() && readsAt(step->command, reg::AlStatus) && !reply.data.empty()) {
        al_.state = static_cast<wire::AlState>(reply.data[0] & wire::AlStateMask);
        al_.error = (reply.data[0] & wire::AlErrorBit) != 0;
        al_.code = 0;
    }
    // Why a device refuses is not in what the list reads; it is asked for before the script ends.
    if (runner_.result() == CommandRunner::Result::StateRefused) {
        wantStatus();
    } else {
        endCommandStep(step->command);
    }
}

void SlaveAgent::endCommandStep(const ListedCommand& command) noexcept {
    ScriptFailure failure;
    failure.address = command.ado;
    failure.number = runner_.seen();
    switch (runner_.result()) {
        case CommandRunner::Result::Idle:
        case CommandRunner::Result::Busy:
            return;
        case CommandRunner::Result::Done:
            stepDone();
            return;
        case CommandRunner::Result::Lost:
        case CommandRunner::Result::WrongCounter:
            failure.kind = ScriptFailure::Kind::CommandUnanswered;
            break;
        case CommandRunner::Result::Mismatch:
            failure.kind = ScriptFailure::Kind::CommandMismatch;
            break;
        case CommandRunner::Result::StateRefused:
            failure.kind = ScriptFailure::Kind::StateRefused;
            failure.target =
                static_cast<wire::AlState>(command.validation->data[0] & wire::AlStateMask);
            break;
    }
    failure.seen = al_;
    fail(failure);
}

void SlaveAgent::takeStatus(const Reply& reply) noexcept {
    if (reply.served()) {
        al_ = decodeAlStatus(reply.data);
        answers_ = true;
        statusWanted_ = false;
    } else if (++statusTries_ >= ReadTries) {
        answers_ = false;
        statusWanted_ = false;
    }
}

void SlaveAgent::takeDifference(const Reply& reply) noexcept {
    if (reply.served()) {
        difference_ = core::Duration{wire::load32(reply.data, 0) & DifferenceMask};
        differenceWanted_ = false;
    } else if (++differenceTries_ >= ReadTries) {
        difference_.reset();
        differenceWanted_ = false;
    }
}

void SlaveAgent::takeRegister(const Reply& reply) noexcept {
    const auto* write = std::get_if<RegisterStep>(&(*script_)[position_]);
    if (write == nullptr) return;
    if (reply.served()) {
        stepDone();
    } else if (++registerTries_ >= RegisterTries) {
        if (write->required) {
            fail({ScriptFailure::Kind::RegisterSilent, write->address, 0, 0, wire::AlState::None,
                  al_});
        } else {
            stepDone();
        }
    }
}

// --- ends of steps
// -----------------------------------------------------------------------------------

void SlaveAgent::endStateStep() noexcept {
    ScriptFailure failure;
    switch (walker_.result()) {
        case AlWalker::Result::Idle:
        case AlWalker::Result::Busy:
            return;
        case AlWalker::Result::Reached:
            stepDone();
            return;
        case AlWalker::Result::Refused:
            failure.kind = ScriptFailure::Kind::StateRefused;
            break;
        case AlWalker::Result::TimedOut:
            failure.kind = ScriptFailure::Kind::StateTimedOut;
            break;
        case AlWalker::Result::Silent:
            failure.kind = ScriptFailure::Kind::StateSilent;
            answers_ = false;
            break;
    }
    failure.target = walker_.target();
    failure.seen = walker_.seen();
    fail(failure);
}

void SlaveAgent::afterMailbox() noexcept {
    const core::ObjectReply& reply = coe_->client.reply();
    if (reply.state == core::ObjectState::Pending) return;
    if (asking_ != nullptr) {
        asking_->end(reply);
        asking_ = nullptr;
    } else if (scriptState_ == ScriptState::Running && stepStarted_) {
        if (const auto* object = std::get_if<ObjectStep>(&(*script_)[position_])) {
            endObjectStep(*object);
        }
    }
}

void SlaveAgent::endObjectStep(const ObjectStep& step) noexcept {
    const core::ObjectReply& reply = coe_->client.reply();
    if (reply.state == core::ObjectState::Failed) {
        if (step.required) {
            fail({ScriptFailure::Kind::ObjectAborted, step.address.index, step.address.subindex,
                  reply.abortCode, wire::AlState::None, al_});
            return;
        }
        notes_.push({step.address, reply.abortCode});
    }
    stepDone();
}

void SlaveAgent::stepDone() noexcept {
    stepStarted_ = false;
    registerTries_ = 0;
    if (++position_ == script_->size()) scriptState_ = ScriptState::Done;
}

void SlaveAgent::fail(const ScriptFailure& failure) noexcept {
    failure_ = failure;
    scriptState_ = ScriptState::Failed;
}

// --- objects for the user
// ------------------------------------------------------------------------------

std::uint32_t SlaveAgent::whyNoObjects() const noexcept {
    if (!coe_) return NoDictionary;
    return al_.state < wire::AlState::PreOp ? wire::abortcode::WrongDeviceState : 0;
}

template <typename Start>
bool SlaveAgent::Door::begin(const Start& start) noexcept {
    if (reply_.state == core::ObjectState::Pending) return false;
    if (const std::uint32_t abortCode = agent_.whyNoObjects(); abortCode != 0) {
        reply_ = {core::ObjectState::Failed, {}, abortCode};
        return true;
    }
    if (!start(agent_.coe_->client)) return false;
    reply_ = {core::ObjectState::Pending, {}, 0};
    agent_.asking_ = this;
    agent_.wake();
    return true;
}

bool SlaveAgent::Door::startRead(core::ObjectAddress address) noexcept {
    return begin([address](CoeClient& client) { return client.startRead(address); });
}

bool SlaveAgent::Door::startWrite(core::ObjectAddress address,
                                  const core::ObjectValue& value) noexcept {
    return begin([&](CoeClient& client) { return client.startWrite(address, value); });
}

}  // namespace takt::fieldbus::ethercat
