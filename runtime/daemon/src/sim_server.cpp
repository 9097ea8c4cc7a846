#include "sim_server.hpp"

#include <span>

namespace takt::daemon {

namespace {

constexpr std::size_t Batch = 32;
constexpr std::size_t EventRoom = 4096;
/// How long nothing must come before the world goes on without a frame.
constexpr core::Duration Quiet = std::chrono::milliseconds{20};

bool differ(const twin::DeviceProbe& a, const twin::DeviceProbe& b) noexcept {
    return a.alState != b.alState || a.alError != b.alError || a.alStatusCode != b.alStatusCode ||
           a.driveState != b.driveState;
}

}  // namespace

SimServer::SimServer(const config::MachineConfig& machine, const std::string& interface)
    : twin_{machine.twin, machine.twinDevices, machine.network.cycle},
      link_{interface, Batch},
      origin_{clock_.now()},
      incoming_(Batch),
      replies_(Batch),
      seen_(twin_.deviceCount()),
      events_{EventRoom} {}

void SimServer::serve() noexcept {
    while (!stopped_.load(std::memory_order_relaxed)) {
        const core::HostTime before = clock_.now();
        const std::size_t count = link_.receiveAny(incoming_, before + Quiet);
        if (count > 0) {
            answer(count);
            // One device for each frame: looking must not make a large segment slow.
            look(nextLook_);
            nextLook_ = nextLook_ + 1 == seen_.size() ? 0 : nextLook_ + 1;
            continue;
        }
        // Nothing has arrived since `before`, so nothing can still come that arrived earlier.
        twin_.advance(trueAt(before));
        for (std::size_t i = 0; i < seen_.size(); ++i) look(i);
    }
}

void SimServer::answer(std::size_t count) noexcept {
    for (const wire::Frame& frame : std::span{incoming_}.first(count)) {
        twin_.arrive(frame, trueAt(frame.stamp));
    }
    const std::size_t back = twin_.comeBack(replies_);
    if (back > 0) link_.send(std::span{replies_}.first(back));
    frames_ += count;
}

void SimServer::look(std::size_t device) noexcept {
    const twin::DeviceProbe probe = twin_.probe(device);
    if (!differ(probe, seen_[device])) return;
    seen_[device] = probe;
    events_.push({device, twin_.trueTime(), probe});
}

}  // namespace takt::daemon
