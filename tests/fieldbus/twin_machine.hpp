#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <takt/fieldbus/ethercat/master.hpp>
#include <takt/scheduler/dc_lock.hpp>
#include <takt/twin/twin.hpp>
#include <vector>

#include "../twin/devices.hpp"

namespace takt::test {

/// Simulated drives in a line, the master in front of them, and the cycle that keeps both together.
class TwinMachine {
public:
    TwinMachine(const twin::TwinParams& devices, core::Duration cycle)
        : network_{networkOf(devices, cycle)},
          twin_{devices, descriptionsOf(network_), cycle},
          master_{network_, twin_.link(), twin_.clock()},
          lock_{{}, cycle} {}
    /// For tests that change what is configured, not what is there.
    TwinMachine(const twin::TwinParams& devices, const fieldbus::NetworkParams& configured)
        : network_{configured},
          twin_{devices, descriptionsOf(networkOf(devices, configured.cycle)), configured.cycle},
          master_{configured, twin_.link(), twin_.clock()},
          lock_{{}, configured.cycle} {}

    static fieldbus::NetworkParams networkOf(const twin::TwinParams& devices,
                                             core::Duration cycle) {
        fieldbus::NetworkParams network;
        network.cycle = cycle;
        for (const auto& device : devices.devices) {
            fieldbus::SlaveParams slave;
            slave.name = device.slave;
            slave.position = static_cast<std::uint16_t>(network.slaves.size());
            slave.device = twin::test::servoDescription(device.profile);
            slave.outputs = {pdoOf(slave.device->rxPdos[0])};
            slave.inputs = {pdoOf(slave.device->txPdos[0])};
            slave.dc.enabled = true;
            network.slaves.push_back(slave);
        }
        return network;
    }

    std::vector<std::string> bringUp() {
        std::vector<std::string> lines;
        for (const auto& problem : master_.bringUp({})) lines.push_back(problem.text);
        wake_ = master_.firstSend(twin_.clock().now());
        return lines;
    }
    void cycle(std::size_t count = 1) {
        for (std::size_t i = 0; i < count; ++i) {
            twin_.clock().sleepUntil(wake_);
            const core::Duration late = twin_.clock().now() - wake_;
            master_.exchange(number_++);
            const auto& sample = master_.dcSample();
            wake_ += network_.cycle +
                     (sample.valid ? lock_.update(sample.phaseError - late) : lock_.coast());
            master_.setClockLocked(lock_.locked());
            master_.prepare();
        }
    }
    bool toOp() {
        using fieldbus::ethercat::NetworkState;
        master_.requestOp();
        for (int i = 0; i < 5000 && master_.state() != NetworkState::Op; ++i) {
            cycle();
            if (master_.state() == NetworkState::Failed) return false;
        }
        return master_.state() == NetworkState::Op;
    }

    [[nodiscard]] fieldbus::ethercat::Master& master() noexcept { return master_; }
    [[nodiscard]] twin::Twin& twin() noexcept { return twin_; }
    [[nodiscard]] const scheduler::DcLock& lock() const noexcept { return lock_; }
    [[nodiscard]] const fieldbus::NetworkParams& network() const noexcept { return network_; }

private:
    static fieldbus::PdoParams pdoOf(const wire::PdoDescription& description) {
        fieldbus::PdoParams pdo{description.index, {}, false};
        for (const auto& entry : description.entries) {
            pdo.entries.push_back({entry.index, entry.subindex, entry.bits});
        }
        return pdo;
    }
    static std::vector<std::shared_ptr<const wire::DeviceDescription>> descriptionsOf(
        const fieldbus::NetworkParams& network) {
        std::vector<std::shared_ptr<const wire::DeviceDescription>> list;
        for (const auto& slave : network.slaves) list.push_back(slave.device);
        return list;
    }

    fieldbus::NetworkParams network_;
    twin::Twin twin_;
    fieldbus::ethercat::Master master_;
    scheduler::DcLock lock_;
    core::HostTime wake_{};
    core::CycleNumber number_{0};
};

}  // namespace takt::test
