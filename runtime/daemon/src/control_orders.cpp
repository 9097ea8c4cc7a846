// What clients of the control server ask the machine to do.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "control_server.hpp"
#include "object_text.hpp"

namespace takt::daemon {

namespace {

constexpr std::size_t MostTickets = 256;

std::uint16_t indexOf(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::uint16_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

void ControlServer::order(std::uint64_t number, Client& client, const ControlRequest& request) {
    ControlCommand command;
    if (std::string why = commandOf(request, command); !why.empty())
        return refuse(client, request, why);
    if (command.order == Order::ProgramReset && preparation_)
        return refuse(client, request, "busy: another program is being made ready");
    const bool isHeartbeat = command.order == Order::Heartbeat;
    // A heartbeat of somebody who does not operate means nothing; anybody may stop the machine, and
    // look at it.
    if (isHeartbeat && owner_ != number) return;
    const bool leaves = command.order == Order::Leave;
    if (leaves && owner_ != number)
        return refuse(client, request, "this client does not operate the machine");
    if (command.order != Order::MachineStop && command.order != Order::Upload) {
        if (std::string why = claim(number, client); !why.empty())
            return refuse(client, request, why);
    }
    if (!isHeartbeat) {
        if (tickets_.size() >= MostTickets)
            return refuse(client, request, "too many commands at once");
        command.ticket = ++lastTicket_;
        tickets_[command.ticket] = {number, request.id, command.order, command.target};
    }
    if (command.order == Order::ProgramReset) return prepareProgram(command);
    if (parts_.control.rings().commands.push(command) || isHeartbeat) {
        if (leaves) owner_ = 0;
        return;
    }
    tickets_.erase(command.ticket);
    refuse(client, request, "busy: the machine has not yet taken the commands before");
}

/// \return why there is no such command; empty when there is
std::string ControlServer::commandOf(const ControlRequest& request, ControlCommand& command) const {
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

std::string ControlServer::targetOf(const ControlRequest& request, ControlCommand& command) const {
    const OrderTarget kind = daemon::targetOf(command.order);
    if (kind == OrderTarget::None) return {};
    const auto& known = namesOf(kind, parts_.control.names());
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
std::string ControlServer::claim(std::uint64_t number, const Client& client) {
    const auto now = std::chrono::steady_clock::now();
    if (owner_ != 0 && owner_ != number) {
        if (now - ownerSeen_ <= OwnerTime)
            return fmt::format("the machine is operated by {}", ownerName());
        leave();
    }
    if (leavePending_) return "busy: the operator before has just left";
    static_cast<void>(client);
    owner_ = number;
    ownerSeen_ = now;
    return {};
}

void ControlServer::prepareProgram(const ControlCommand& command) {
    preparation_ = std::make_unique<Preparation>();
    preparation_->command = command;
    preparation_->thread = std::thread{[this, &work = *preparation_] {
        work.problems = parts_.stock.prepare(work.command.target);
        work.over.store(true, std::memory_order_release);
    }};
}

void ControlServer::takePrepared() {
    if (!preparation_ || !preparation_->over.load(std::memory_order_acquire)) return;
    preparation_->thread.join();
    const auto work = std::move(preparation_);
    std::string why = fmt::format("{}", fmt::join(work->problems, "; "));
    if (why.empty() && parts_.control.rings().commands.push(work->command)) return;
    if (why.empty()) why = "busy: the machine has not yet taken the commands before";
    const auto ticket = tickets_.find(work->command.ticket);
    if (ticket == tickets_.end()) return;
    const auto client = clients_.find(ticket->second.client);
    if (client != clients_.end()) {
        client->second.unsent += encode(ControlReply{
            .id = ticket->second.request, .kind = ReplyKind::Refused, .error = std::move(why)});
    }
    tickets_.erase(ticket);
}

}  // namespace takt::daemon
