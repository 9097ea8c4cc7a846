#include "command_runner.hpp"

#include <takt/wire/al_state.hpp>
#include <takt/wire/registers.hpp>

namespace takt::fieldbus::ethercat {

namespace {

using wire::Command;

constexpr std::uint8_t LostTries = 5;
constexpr core::Duration CommandGap = std::chrono::milliseconds{1};
constexpr core::Duration LookGap = std::chrono::microseconds{250};

/// The first four bytes as far as they are there, through the mask.
std::uint32_t firstBytes(std::span<const std::uint8_t> data,
                         const std::vector<std::uint8_t>& mask) noexcept {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < data.size() && i < 4; ++i) {
        const unsigned byte = i < mask.size() ? data[i] & mask[i] : data[i];
        value |= std::uint32_t{byte} << (8U * i);
    }
    return value;
}

bool agrees(const ListedValidation& wanted, std::span<const std::uint8_t> data) noexcept {
    if (data.size() < wanted.data.size()) return false;
    for (std::size_t i = 0; i < wanted.data.size(); ++i) {
        if ((data[i] & wanted.mask[i]) != wanted.data[i]) return false;
    }
    return true;
}

/// The list waits for a state without error, and the device shows an error: it will not come.
bool showsRefusal(const ListedCommand& command, std::span<const std::uint8_t> data) noexcept {
    const ListedValidation& wanted = *command.validation;
    return readsAt(command, wire::reg::AlStatus) && !data.empty() && !wanted.mask.empty() &&
           (wanted.mask[0] & wire::AlErrorBit) != 0 && (wanted.data[0] & wire::AlErrorBit) == 0 &&
           (data[0] & wire::AlErrorBit) != 0;
}

}  // namespace

bool writes(const ListedCommand& command) noexcept {
    switch (static_cast<Command>(command.command)) {
        case Command::Apwr:
        case Command::Aprw:
        case Command::Fpwr:
        case Command::Fprw:
        case Command::Bwr:
        case Command::Brw:
        case Command::Lwr:
        case Command::Lrw:
        case Command::Armw:
        case Command::Frmw:
            return true;
        case Command::Nop:
        case Command::Aprd:
        case Command::Fprd:
        case Command::Brd:
        case Command::Lrd:
            return false;
    }
    return false;
}

bool readsAt(const ListedCommand& command, std::uint16_t address) noexcept {
    const auto number = static_cast<Command>(command.command);
    const bool reads = number == Command::Aprd || number == Command::Fprd || number == Command::Brd;
    return reads && command.ado == address;
}

void CommandRunner::start(const ListedCommand& command) noexcept {
    command_ = &command;
    result_ = Result::Busy;
    timed_ = false;
    notBefore_ = nextCommand_;
    wrong_ = 0;
    lost_ = 0;
    seen_ = 0;
}

bool CommandRunner::next(core::HostTime now, Request& request) noexcept {
    if (result_ != Result::Busy || now < notBefore_) return false;
    if (!timed_) {
        timed_ = true;
        nextCommand_ = now + CommandGap;
        deadline_ = now;
        if (command_->validation) deadline_ += command_->validation->timeout;
    }
    request = {static_cast<Command>(command_->command), command_->adp, command_->ado,
               static_cast<std::uint16_t>(command_->data.size()), command_->data};
    return true;
}

void CommandRunner::take(core::HostTime now, const Reply& reply) noexcept {
    if (result_ != Result::Busy) return;
    if (!reply.arrived) {
        if (++lost_ >= LostTries) result_ = Result::Lost;
        return;
    }
    lost_ = 0;
    const bool counted =
        !command_->workingCounter || *command_->workingCounter == reply.workingCounter;
    if (counted) {
        takeData(now, reply.data);
    } else if (command_->validation && now < deadline_) {
        notBefore_ = now + LookGap;  // a device that does not answer yet may do so in time
    } else if (++wrong_ > command_->retries) {
        seen_ = reply.workingCounter;
        result_ = Result::WrongCounter;
    }
}

void CommandRunner::takeData(core::HostTime now, std::span<const std::uint8_t> data) noexcept {
    if (!command_->validation) {
        result_ = Result::Done;
        return;
    }
    const ListedValidation& wanted = *command_->validation;
    seen_ = firstBytes(data, wanted.mask);
    if (agrees(wanted, data)) {
        result_ = Result::Done;
    } else if (showsRefusal(*command_, data)) {
        result_ = Result::StateRefused;
    } else if (now >= deadline_) {
        result_ = Result::Mismatch;
    } else {
        notBefore_ = now + LookGap;
    }
}

}  // namespace takt::fieldbus::ethercat
