#include "publisher.hpp"

#include <algorithm>

namespace takt::bridge {

namespace {

using namespace std::chrono_literals;

/// Periods in one go after the bridge was kept from running: more would overrun the sockets of
/// the subscribers.
constexpr int MostPeriods = 8;
constexpr std::chrono::nanoseconds LongestRest = 5ms;
constexpr std::chrono::nanoseconds ShortestRest = 1ms;

}  // namespace

bool Publisher::step() {
    publishEvents();
    publishReplies();
    handOver();
    for (int i = 0; i < MostPeriods; ++i) {
        if (!publishPeriod()) return false;
    }
    return true;
}

std::chrono::nanoseconds Publisher::rest() const noexcept {
    const StatusHeader& header = status_.header();
    const std::chrono::nanoseconds period{header.cycleNs * header.everyCycles};
    return std::clamp(period / 4, ShortestRest, LongestRest);
}

/// The samples of one cycle. \return false when there are none yet
bool Publisher::publishPeriod() {
    MachineSample machine;
    if (!status_.machine(machine)) return false;
    node_.publish(machine);
    for (std::size_t i = 0; i < status_.axisNames().size(); ++i) {
        AxisSample sample;
        if (status_.axis(i, sample)) node_.publishAxis(i, sample);
    }
    for (std::size_t i = 0; i < status_.groupNames().size(); ++i) {
        GroupSample sample;
        if (status_.group(i, sample)) node_.publishGroup(i, sample);
    }
    node_.flush();
    commands_.published(++published_);
    return true;
}

void Publisher::publishEvents() {
    EventRecord event;
    while (event_ || status_.event(event)) {
        if (event_) event = *event_;
        event_.reset();
        if (node_.publish(event)) continue;
        event_ = event;
        return;
    }
}

void Publisher::publishReplies() {
    ReplyRecord reply;
    while (reply_ || status_.reply(reply)) {
        if (reply_) reply = *reply_;
        reply_.reset();
        if (node_.publish(reply)) continue;
        reply_ = reply;
        return;
    }
}

void Publisher::handOver() {
    for (const CommandRecord& command : node_.takeCommands()) {
        if (!isWellFormed(command)) {
            refuse(command, "a number is not finite, or a text is not printable");
        } else if (!commands_.send(command)) {
            refuse(command, "busy: the machine has not yet taken the commands before");
        }
    }
}

void Publisher::refuse(const CommandRecord& command, std::string_view why) {
    ReplyRecord refused{
        .client = command.client, .request = command.request, .kind = ReplyKind::Refused};
    put(refused.why, why);
    static_cast<void>(node_.publish(refused));
}

}  // namespace takt::bridge
