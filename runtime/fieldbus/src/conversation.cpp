#include "conversation.hpp"

#include <algorithm>

#include "logical_layout.hpp"

namespace takt::fieldbus::ethercat {

namespace {

constexpr core::Duration ReplyTimeout = std::chrono::milliseconds{5};
constexpr core::Duration IdleGap = std::chrono::microseconds{250};
constexpr int AskTries = 5;

}  // namespace

wire::LinkStatus Conversation::exchange() {
    frames_.finish();
    linkStatus_ = frames_.send(link_);
    if (linkStatus_ == wire::LinkStatus::Ok) frames_.receive(link_, clock_.now() + ReplyTimeout);
    return linkStatus_;
}

Reply Conversation::ask(const Request& request) {
    Reply reply;
    for (int i = 0; i < AskTries && !reply.served(); ++i) {
        frames_.begin();
        frames_.openFrame();
        const DatagramId id =
            frames_.append(request.command, request.adp, request.ado, request.length);
        std::copy(request.data.begin(), request.data.end(), frames_.data(id).begin());
        if (exchange() != wire::LinkStatus::Ok) {
            pause(ReplyTimeout);
            continue;
        }
        reply = frames_.reply(id);
    }
    return reply;
}

void Conversation::run(AcyclicSlice& slice, std::span<AcyclicMachine* const> machines) {
    for (std::size_t i = 0; i < machines.size(); ++i) slice.work().set(i);
    const auto busy = [](const AcyclicMachine* machine) { return machine->busy(); };
    while (std::any_of(machines.begin(), machines.end(), busy)) {
        frames_.begin();
        frames_.openFrame();
        slice.fill(frames_, machines, FrameCapacity, clock_.now());
        if (frames_.empty()) {
            pause(IdleGap);
            continue;
        }
        // A dead link is for the machines a lost frame; time must go on for their time-outs.
        if (exchange() != wire::LinkStatus::Ok) pause(ReplyTimeout);
        slice.deliver(frames_, machines, clock_.now());
    }
}

void Conversation::pause(core::Duration duration) {
    clock_.sleepUntil(clock_.now() + duration);
}

}  // namespace takt::fieldbus::ethercat
