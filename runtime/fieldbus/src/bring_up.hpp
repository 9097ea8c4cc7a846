#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <takt/fieldbus/ethercat/bring_up_problem.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <vector>

#include "conversation.hpp"
#include "cycle_plan.hpp"
#include "device_scan.hpp"
#include "listed_script.hpp"
#include "reference_clock.hpp"
#include "slave_agent.hpp"

namespace takt::fieldbus::ethercat {

/// Station address of a slave.
[[nodiscard]] constexpr std::uint16_t stationOf(std::size_t slave) noexcept {
    return static_cast<std::uint16_t>(1001 + slave);
}

/// The same on a network whose list may say otherwise. Devices that no list knows keep out of its
/// numbers.
[[nodiscard]] inline std::uint16_t stationOf(const NetworkParams& network,
                                             std::size_t slave) noexcept {
    if (!network.listed) return stationOf(slave);
    constexpr std::size_t unlisted = 0xF000;
    const bool known = slave < network.slaves.size() && network.slaves[slave].listed;
    return known ? network.slaves[slave].listed->station
                 : static_cast<std::uint16_t>(unlisted + slave);
}

/// Everything between a silent wire and a network in PREOP that is ready for the cyclic phase:
/// count, reset, addresses, identity, clocks, objects, SyncManagers, FMMUs, SYNC0. Runs outside the
/// cycle.
class BringUp {
public:
    using Progress = std::function<void(std::string_view)>;

    struct Parts {
        const NetworkParams& network;
        const LogicalLayout& layout;
        const CyclePlan& plan;
        AcyclicSlice& slice;
        std::span<AcyclicMachine* const> machines;
        std::vector<std::unique_ptr<SlaveAgent>>& agents;
        std::vector<SlaveScripts>& scripts;
        SlaveAgent& everyone;
        const CommonScripts& common;
        ReferenceClock& reference;
    };

    /// \param goOn false: breaks it off
    BringUp(const Parts& parts, Conversation& talk, const Progress& progress,
            const std::function<bool()>& goOn);

    /// \return all problems found before the step that could not be left; empty = ready
    std::vector<BringUpProblem> run();
    /// The slave whose clock leads; meaningful when the reference clock is present.
    [[nodiscard]] std::size_t referenceSlave() const noexcept { return referenceSlave_; }

private:
    void say(std::string_view text) const;
    [[nodiscard]] bool brokenOff() const { return goOn_ && !goOn_(); }
    void breakOff();
    void blameNetwork(std::string text);
    void blame(std::size_t slave, std::string_view text);
    void blame(std::size_t slave, std::string_view text, const std::string& origin);

    void checkParams();
    void checkSlave(std::size_t slave);
    void countDevices();
    void resetDevices();
    void assignAddresses();
    void scan();
    void compareDevices();
    void measureClocks();
    void writeClocks(core::HostTime latched, std::span<const std::uint64_t> local,
                     std::span<const std::uint32_t> delays);
    void leadReference();
    void configure();
    void writeObjects();
    void settleClocks();
    void armSync();
    void runScript(Script SlaveScripts::*script);
    void runCommon(const Script& script);
    [[nodiscard]] bool dcWanted() const;

    Parts parts_;
    Conversation& talk_;
    const Progress& progress_;
    const std::function<bool()>& goOn_;
    std::vector<BringUpProblem> problems_;
    std::vector<ScannedDevice> found_;
    std::size_t count_{0};
    std::size_t referenceSlave_{0};
};

}  // namespace takt::fieldbus::ethercat
