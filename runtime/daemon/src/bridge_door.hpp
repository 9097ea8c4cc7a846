#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <takt/bridge/command_memory.hpp>
#include <takt/bridge/status_memory.hpp>
#include <takt/config/machine_config.hpp>
#include <takt/daemon/control_messages.hpp>

#include "bridge_process.hpp"
#include "command_gate.hpp"

namespace takt::daemon {

/// The daemon's side of the bridge: the memories, the process, and the clients behind it. But for
/// status(), which belongs to the cycle, everything is for the thread that serves the doors.
class BridgeDoor {
public:
    static constexpr std::size_t MostClients = 32;
    static constexpr std::size_t MostCommands = 64;  ///< in one go
    /// Of the machine: a bridge that publishes nothing for so long hangs.
    static constexpr std::chrono::seconds HangTime{5};

    /// The process is started by the first serve(). \throw std::runtime_error when it cannot be
    explicit BridgeDoor(const config::MachineConfig& machine);

    [[nodiscard]] bridge::StatusWriter& status() noexcept { return status_; }

    /// Looks after the process and hands its commands to the gate. \param cycle the last one
    /// \return what became of the process, in words; empty when nothing has changed
    std::string serve(CommandGate& gate, core::CycleNumber cycle);
    /// \return false when the client is not one of this door
    bool answer(CommandGate::Client client, const ControlReply& reply);
    void tell(const EventReport& event);
    /// Ends the process; it publishes first what it has not yet.
    void close() { process_.stop(); }

    [[nodiscard]] const BridgeProcess& process() const noexcept { return process_; }
    /// Status samples that the present process has published, by its own account.
    [[nodiscard]] std::uint64_t published() const noexcept { return commands_.published(); }

private:
    /// One DDS writer.
    struct Remote {
        CommandGate::Client client{CommandGate::Nobody};
        std::uint64_t key{0};  ///< as he calls himself
    };

    void take(const bridge::CommandRecord& record, CommandGate& gate);
    void reply(std::uint64_t key, const ControlReply& reply);
    void forgetAll(CommandGate& gate);
    void watchProgress(core::CycleNumber cycle);

    bridge::StatusWriter status_;
    bridge::CommandReceiver commands_;
    BridgeProcess process_;
    bool takesCommands_;
    core::CycleNumber hangCycles_;
    core::CycleNumber progressCycle_{0};  ///< in which it was last seen to publish
    std::uint64_t progress_{0};
    std::map<std::uint64_t, Remote> remotes_;  ///< by writer
};

}  // namespace takt::daemon
