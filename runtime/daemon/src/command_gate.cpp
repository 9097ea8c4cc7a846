#include "command_gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <takt/wire/al_state.hpp>
#include <utility>

#include "object_text.hpp"

namespace takt::daemon {

namespace {

constexpr std::size_t MostTickets = 256;

ReplyKind kindOf(AnswerKind kind) noexcept {
    return static_cast<ReplyKind>(kind);
}
static_assert(static_cast<int>(ReplyKind::Failed) == static_cast<int>(AnswerKind::Failed));

std::uint16_t indexOf(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::uint16_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

std::string CommandGate::submit(Client client, const std::string& name,
                                const ControlRequest& request) {
    ControlCommand command;
    if (std::string why = commandOf(request, command); !why.empty()) return why;
    if (command.order == Order::ProgramReset && preparation_)
        return "busy: another program is being made ready";
    const bool isHeartbeat = command.order == Order::Heartbeat;
    // A heartbeat of somebody who does not operate means nothing; anybody may stop the machine, and
    // look at it.
    if (isHeartbeat && owner_ != client) return {};
    const bool leaves = command.order == Order::Leave;
    if (leaves && owner_ != client) return "this client does not operate the machine";
    if (command.order != Order::MachineStop && command.order != Order::Upload) {
        if (std::string why = claim(client, name); !why.empty()) return why;
    }
    if (!isHeartbeat) {
        if (tickets_.size() >= MostTickets) return "too many commands at once";
        command.ticket = ++lastTicket_;
        tickets_[command.ticket] = {client, request.id, command.order, command.target};
    }
    if (command.order == Order::ProgramReset) {
        prepareProgram(command);
        return {};
    }
    if (control_.rings().commands.push(command) || isHeartbeat) {
        if (leaves) owner_ = Nobody;
        if (leaves) ownerName_.clear();
        return {};
    }
    tickets_.erase(command.ticket);
    return "busy: the machine has not yet taken the commands before";
}

/// \return why there is no such command; empty when there is
std::string CommandGate::commandOf(const ControlRequest& request, ControlCommand& command) const {
    const auto order = orderOf(request.verb);
    if (!order) return fmt::format("there is no request '{}'", request.verb);
    command.order = *order;
    command.distance = request.distance;
    command.velocity = request.velocity;
    command.force = request.force;
    if (std::string why = targetOf(request, command); !why.empty()) return why;
    if (daemon::targetOf(*order) != OrderTarget::Device) return {};
    if (!parseObject(request.object, command.object)) return "\"object\" must be like \"0x6065:0\"";
    if (*order == Order::Download && !parseBytes(request.data, command.value))
        return "\"data\" must be one to eight bytes in hexadecimal";
    return {};
}

std::string CommandGate::targetOf(const ControlRequest& request, ControlCommand& command) const {
    const OrderTarget kind = daemon::targetOf(command.order);
    if (kind == OrderTarget::None) return {};
    const auto& known = namesOf(kind, control_.names());
    const char* const word = kind == OrderTarget::Axis      ? "axis"
                             : kind == OrderTarget::Program ? "program"
                                                            : "device";
    const std::string& wanted = kind == OrderTarget::Axis      ? request.axis
                                : kind == OrderTarget::Program ? request.program
                                                               : request.device;
    command.target = indexOf(known, wanted);
    if (command.target < known.size()) return {};
    if (kind == OrderTarget::Device) {
        const char* const end = wanted.data() + wanted.size();
        const auto [rest, error] = std::from_chars(wanted.data(), end, command.target);
        if (error == std::errc{} && rest == end && command.target < known.size()) return {};
    }
    return fmt::format("there is no {} '{}'; allowed: {}", word, wanted, fmt::join(known, ", "));
}

/// Makes the client the owner, or says who is.
std::string CommandGate::claim(Client client, const std::string& name) {
    const auto now = std::chrono::steady_clock::now();
    if (owner_ != Nobody && owner_ != client) {
        if (now - ownerSeen_ <= OwnerTime)
            return fmt::format("the machine is operated by {}", ownerName_);
        release();
    }
    if (leavePending_) return "busy: the operator before has just left";
    owner_ = client;
    ownerName_ = name;
    ownerSeen_ = now;
    return {};
}

std::optional<CommandGate::Answer> CommandGate::nextAnswer() {
    if (auto prepared = takePrepared()) return prepared;
    ControlAnswer answer;
    while (control_.rings().answers.pop(answer)) {
        const auto found = tickets_.find(answer.ticket);
        if (found == tickets_.end()) continue;
        const Ticket ticket = found->second;
        if (answer.kind != AnswerKind::Accepted) tickets_.erase(found);
        return answerTo(ticket, answer);
    }
    return std::nullopt;
}

CommandGate::Answer CommandGate::answerTo(const Ticket& ticket, const ControlAnswer& answer) const {
    ControlReply reply{
        .id = ticket.request, .kind = kindOf(answer.kind), .error = {}, .cycle = answer.cycle};
    reply.data = formatBytes(answer.value);
    reply.abortCode = answer.abortCode;
    if (answer.abortCode != 0) {
        reply.error =
            fmt::format("0x{:08X} {}", answer.abortCode, wire::explainAbort(answer.abortCode));
    }
    if (answer.error != axis::ErrorId::None) {
        const axis::ErrorInfo& info = axis::errorInfo(answer.error);
        reply.error = fmt::format("{}: {} {}", info.name, info.text, info.remedy);
    } else if (answer.refusal != Refusal::None) {
        reply.error =
            explain(answer.refusal, ticket.order, ticket.target, answer.detail, control_.names());
    }
    return {ticket.client, std::move(reply)};
}

void CommandGate::prepareProgram(const ControlCommand& command) {
    preparation_ = std::make_unique<Preparation>();
    preparation_->command = command;
    preparation_->thread = std::thread{[this, &work = *preparation_] {
        work.problems = stock_.prepare(work.command.target);
        work.over.store(true, std::memory_order_release);
    }};
}

/// Hands what is ready to the cycle. \return the answer where it cannot be had
std::optional<CommandGate::Answer> CommandGate::takePrepared() {
    if (!preparation_ || !preparation_->over.load(std::memory_order_acquire)) return std::nullopt;
    preparation_->thread.join();
    const auto work = std::move(preparation_);
    std::string why = fmt::format("{}", fmt::join(work->problems, "; "));
    if (why.empty() && control_.rings().commands.push(work->command)) return std::nullopt;
    if (why.empty()) why = "busy: the machine has not yet taken the commands before";
    const auto found = tickets_.find(work->command.ticket);
    if (found == tickets_.end()) return std::nullopt;
    Answer refused{found->second.client, {.id = found->second.request, .kind = ReplyKind::Refused}};
    refused.reply.error = std::move(why);
    tickets_.erase(found);
    return refused;
}

void CommandGate::finish() {
    if (preparation_ && preparation_->thread.joinable()) preparation_->thread.join();
}

void CommandGate::watchOwner() {
    if (owner_ != Nobody) {
        const bool waits = std::any_of(tickets_.begin(), tickets_.end(), [this](const auto& entry) {
            return entry.second.client == owner_;
        });
        const bool silent = std::chrono::steady_clock::now() - ownerSeen_ > OwnerTime;
        if (silent && !waits) release();
    }
    if (!leavePending_) return;
    leavePending_ = !control_.rings().commands.push({.order = Order::Leave});
}

void CommandGate::leave(Client client) {
    if (client == owner_ && client != Nobody) release();
}

void CommandGate::release() {
    owner_ = Nobody;
    ownerName_.clear();
    leavePending_ = !control_.rings().commands.push({.order = Order::Leave});
}

}  // namespace takt::daemon
