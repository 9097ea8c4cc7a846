#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <takt/core/time.hpp>
#include <takt/fieldbus/ethercat/network_state.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <vector>

#include "listed_script.hpp"
#include "process_data.hpp"
#include "slave_agent.hpp"

namespace takt::fieldbus::ethercat {

/// What one cycle told about the bus as a whole.
struct BusReading {
    bool statusArrived{false};
    std::uint16_t status{0};         ///< OR of all AL status registers
    std::uint16_t statusCounter{0};  ///< devices that answered
    bool clockLocked{false};
    bool hasReference{false};
};

/// Leads all slaves together up to OP and down to INIT, inside the cycles, and watches over them in
/// OP.
class NetworkWalk {
public:
    /// `everyone` runs the commands to all devices, `common`.
    NetworkWalk(const NetworkParams& network, std::vector<std::unique_ptr<SlaveAgent>>& agents,
                std::vector<SlaveScripts>& scripts, SlaveAgent& everyone,
                const CommonScripts& common, ProcessData& data);

    /// After bring-up. `reference`: the slave whose clock leads.
    void begin(std::size_t reference) noexcept;
    /// rt. From PREOP up to OP; in OP: those that fell back are led to OP again.
    void requestOp() noexcept { opWanted_ = true; }
    /// rt. From any state down to INIT.
    void requestInit() noexcept { initWanted_ = true; }
    /// rt. One step per cycle, after the replies have been taken.
    void step(core::CycleNumber cycle, core::HostTime now, const BusReading& reading) noexcept;
    /// rt. The working counters of process data are meaningful.
    [[nodiscard]] bool supervised() const noexcept;

    [[nodiscard]] NetworkState state() const noexcept { return state_; }
    void off() noexcept { state_ = NetworkState::Off; }
    [[nodiscard]] const NetworkProblem& problem() const noexcept { return problem_; }

private:
    using ScriptOf = Script SlaveScripts::*;

    enum class Stage : std::uint8_t { Before, Slaves, After, Over };

    /// Starts a transition for the slaves that are in `atLeast` or above.
    void begin(Transition transition, ScriptOf script, wire::AlState atLeast) noexcept;
    void startStage() noexcept;
    /// Goes on to the next stage of the transition. \return false when it is over or has failed
    [[nodiscard]] bool underWay() noexcept;
    [[nodiscard]] bool anyRunning() const noexcept;
    [[nodiscard]] bool blame(const SlaveAgent& agent, std::uint16_t slave) noexcept;
    [[nodiscard]] bool blameFailed() noexcept;
    void fail(const NetworkProblem& problem) noexcept;
    void climbed(NetworkState reached) noexcept;
    void waitForOp(core::HostTime now, const BusReading& reading) noexcept;
    void startWaiting(core::HostTime now) noexcept;
    [[nodiscard]] bool clocksQuiet() noexcept;
    [[nodiscard]] NetworkProblem whyNotReady(const BusReading& reading) const noexcept;
    void supervise(const BusReading& reading, wire::AlState expected) noexcept;
    void noteFallen(wire::AlState expected) noexcept;
    void recover() noexcept;
    void startDown() noexcept;
    void goDown() noexcept;
    void updateHealth() noexcept;

    const NetworkParams& network_;
    std::vector<std::unique_ptr<SlaveAgent>>& agents_;
    std::vector<SlaveScripts>& scripts_;
    SlaveAgent& everyone_;
    const CommonScripts& common_;
    ProcessData& data_;
    NetworkState state_{NetworkState::Off};
    NetworkProblem problem_{};
    core::CycleNumber cycle_{0};
    bool opWanted_{false};
    bool initWanted_{false};
    std::uint32_t goodInRow_{0};
    std::uint32_t quietRounds_{0};
    std::uint32_t sinceStatus_{0};
    std::size_t reference_{0};
    bool asked_{false};    ///< AL status of every slave was asked for
    bool allWell_{false};  ///< every slave was in the expected state when last asked
    std::uint8_t downStage_{0};
    Stage stage_{Stage::Over};
    Transition transition_{Transition::InitToPreOp};
    ScriptOf script_{nullptr};
    wire::AlState atLeast_{wire::AlState::None};
    core::HostTime waitUntil_{};
};

}  // namespace takt::fieldbus::ethercat
