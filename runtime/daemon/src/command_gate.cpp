#include "command_gate.hpp"

#include <fmt/format.h>

#include <algorithm>

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
    const bool isHeartbeat = command.order == Order::Heartbeat;
    // A heartbeat of somebody who does not operate means nothing; anybody may stop the machine.
    if (isHeartbeat && owner_ != client) return {};
    if (command.order != Order::MachineStop) {
        if (std::string why = claim(client, name); !why.empty()) return why;
    }
    if (!isHeartbeat) {
        if (tickets_.size() >= MostTickets) return "too many commands at once";
        command.ticket = ++lastTicket_;
        tickets_[command.ticket] = {client, request.id, command.order, command.target};
    }
    if (control_.rings().commands.push(command) || isHeartbeat) return {};
    tickets_.erase(command.ticket);
    return "busy: the machine has not yet taken the commands before";
}

/// \return why there is no such command; empty when there is
std::string CommandGate::commandOf(const ControlRequest& request, ControlCommand& command) const {
    const auto order = orderOf(request.verb);
    if (!order) return fmt::format("there is no request '{}'", request.verb);
    const ControlNames& names = control_.names();
    command.order = *order;
    command.distance = request.distance;
    command.velocity = request.velocity;
    const bool ofAxis = targetOf(*order) == OrderTarget::Axis;
    if (targetOf(*order) == OrderTarget::None) return {};
    const auto& known = ofAxis ? names.axes : names.programs;
    const std::string& wanted = ofAxis ? request.axis : request.program;
    command.target = indexOf(known, wanted);
    if (command.target < known.size()) return {};
    return fmt::format("there is no {} '{}'; allowed: {}", ofAxis ? "axis" : "program", wanted,
                       fmt::join(known, ", "));
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
    ControlAnswer answer;
    while (control_.rings().answers.pop(answer)) {
        const auto found = tickets_.find(answer.ticket);
        if (found == tickets_.end()) continue;
        const Ticket ticket = found->second;
        if (answer.kind != AnswerKind::Accepted) tickets_.erase(found);
        ControlReply reply{
            .id = ticket.request, .kind = kindOf(answer.kind), .error = {}, .cycle = answer.cycle};
        if (answer.error != axis::ErrorId::None) {
            const axis::ErrorInfo& info = axis::errorInfo(answer.error);
            reply.error = fmt::format("{}: {} {}", info.name, info.text, info.remedy);
        } else if (answer.refusal != Refusal::None) {
            reply.error = explain(answer.refusal, ticket.order, ticket.target, answer.detail,
                                  control_.names());
        }
        return Answer{ticket.client, std::move(reply)};
    }
    return std::nullopt;
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
