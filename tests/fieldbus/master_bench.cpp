// Instructions of the bus layer per cycle. Count them with
//
//   valgrind --tool=callgrind --toggle-collect='*oneCycle*' takt_fieldbus_bench DEVICES CYCLES
//
// twice with different numbers of devices: the difference gives the share of one device. The
// segment is replaced by an echo of about a hundred instructions per frame, which are part of the
// count.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <takt/fieldbus/ethercat/master.hpp>
#include <vector>

#include "example_network.hpp"
#include "fake_segment.hpp"

namespace {

using namespace takt;

/// Twelve bytes out and sixteen in for every device.
fieldbus::NetworkParams benchNetwork(std::size_t devices) {
    fieldbus::NetworkParams network = test::exampleNetwork(devices);
    for (auto& slave : network.slaves) {
        slave.outputs[0].entries = {
            {0x6040, 0, 16}, {0x607A, 0, 32}, {0x60FF, 0, 32}, {0x6071, 0, 16}};
        slave.inputs[0].entries = {
            {0x6041, 0, 16}, {0x6064, 0, 32}, {0x606C, 0, 32}, {0x6077, 0, 16}, {0x60FD, 0, 32}};
    }
    return network;
}

/// A fake segment that turns into an echo: what it once changed in a frame it changes in all later
/// ones.
class EchoLink final : public wire::Link {
public:
    explicit EchoLink(wire::Link& real) : real_{real}, frames_(4), changes_(4) {}
    /// Learns from the next exchange, then answers alone.
    void learn() { learning_ = true; }

    wire::LinkStatus send(std::span<wire::Frame> frames) noexcept override {
        if (!echo_) {
            for (std::size_t i = 0; learning_ && i < frames.size(); ++i) frames_[i] = frames[i];
            return real_.send(frames);
        }
        for (std::size_t i = 0; i < frames.size(); ++i) {
            std::memcpy(frames_[i].bytes.data(), frames[i].bytes.data(), frames[i].size);
            frames_[i].size = frames[i].size;
            for (const Change& change : changes_[i]) frames_[i].bytes[change.at] = change.value;
        }
        return wire::LinkStatus::Ok;
    }
    std::size_t receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept override {
        if (echo_) {
            for (std::size_t i = 0; i < slots.size(); ++i) {
                std::memcpy(slots[i].bytes.data(), frames_[i].bytes.data(), frames_[i].size);
                slots[i].size = frames_[i].size;
            }
            return slots.size();
        }
        const std::size_t got = real_.receive(slots, deadline);
        for (std::size_t i = 0; learning_ && i < got; ++i) compare(slots[i], i);
        echo_ = learning_;
        return got;
    }

private:
    struct Change {
        std::size_t at;
        std::uint8_t value;
    };
    void compare(const wire::Frame& reply, std::size_t which) {
        for (std::size_t at = 0; at < reply.size; ++at) {
            if (reply.bytes[at] == frames_[which].bytes[at]) continue;
            changes_[which].push_back({at, reply.bytes[at]});
        }
    }

    wire::Link& real_;
    std::vector<wire::Frame> frames_;
    std::vector<std::vector<Change>> changes_;
    bool learning_{false};
    bool echo_{false};
};

[[gnu::noinline]] void oneCycle(fieldbus::ethercat::Master& master, core::CycleNumber cycle) {
    master.exchange(cycle);
    master.prepare();
}

}  // namespace

int main(int argc, char** argv) {
    const std::size_t devices = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 3;
    const std::size_t cycles = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1000;
    test::FakeClock clock;
    test::FakeSegment segment{clock};
    const fieldbus::NetworkParams network = benchNetwork(devices);
    for (const auto& slave : network.slaves) segment.devices.emplace_back(*slave.device);
    EchoLink link{segment};
    fieldbus::ethercat::Master master{network, link, clock};
    if (!master.bringUp({}).empty()) return EXIT_FAILURE;
    master.setClockLocked(true);
    master.requestOp();
    core::CycleNumber cycle = 0;
    while (master.state() != fieldbus::ethercat::NetworkState::Op && cycle < 10'000) {
        master.exchange(cycle++);
        master.prepare();
    }
    for (int i = 0; i < 20; ++i) {
        master.exchange(cycle++);
        master.prepare();
    }
    link.learn();
    master.exchange(cycle++);
    master.prepare();
    for (std::size_t i = 0; i < cycles; ++i) oneCycle(master, cycle++);
    const auto counters = master.counters();
    std::printf("%zu devices, %zu frames of process data, %llu wrong working counters\n", devices,
                master.groups().size(),
                static_cast<unsigned long long>(counters.workingCounterErrors));
    return counters.workingCounterErrors == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
