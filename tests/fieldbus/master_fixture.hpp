#pragma once

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <takt/fieldbus/ethercat/master.hpp>
#include <vector>

#include "example_network.hpp"
#include "fake_segment.hpp"

namespace takt::test {

/// A master on a fake segment whose devices are the configured ones.
class MasterOnFake : public ::testing::Test {
protected:
    void build(const fieldbus::NetworkParams& params) {
        network = params;
        segment.devices.clear();
        for (const auto& slave : network.slaves) segment.devices.emplace_back(*slave.device);
        master = std::make_unique<fieldbus::ethercat::Master>(network, segment, clock);
    }
    std::vector<std::string> bringUp() {
        std::vector<std::string> lines;
        for (const auto& problem : master->bringUp({})) lines.push_back(problem.text);
        return lines;
    }
    void cycle(std::size_t count = 1) {
        for (std::size_t i = 0; i < count; ++i) {
            clock.sleepUntil(wake);
            wake += network.cycle;
            master->exchange(number++);
            master->prepare();
        }
    }
    /// \return whether OP was reached
    bool toOp() {
        wake = master->firstSend(clock.now());
        master->setClockLocked(true);
        master->requestOp();
        for (int i = 0; i < 2000 && master->state() != fieldbus::ethercat::NetworkState::Op; ++i)
            cycle();
        cycle(5);
        return master->state() == fieldbus::ethercat::NetworkState::Op;
    }

    FakeClock clock;
    FakeSegment segment{clock};
    fieldbus::NetworkParams network;
    std::unique_ptr<fieldbus::ethercat::Master> master;
    core::HostTime wake{};
    core::CycleNumber number{0};
};

}  // namespace takt::test
