#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <takt/daemon/control_messages.hpp>
#include <thread>
#include <vector>

#include "machine_control.hpp"

namespace takt::daemon {

/// Where commands from outside pass on their way to the cycle, whichever door they come through:
/// from one owner at a time, whose answers come back here. One thread.
///
/// Owner is who commands first, until he leaves or is silent for OwnerTime. Stopping and looking
/// are open to all.
class CommandGate {
public:
    static constexpr std::chrono::seconds OwnerTime{1};

    /// Who asks: a number of newClient(), and what he is called when another one is told of him.
    using Client = std::uint64_t;
    static constexpr Client Nobody = 0;

    struct Answer {
        Client client{Nobody};
        ControlReply reply;
    };

    CommandGate(MachineControl& control, ProgramStock& stock) : control_{control}, stock_{stock} {}
    ~CommandGate() { finish(); }
    CommandGate(const CommandGate&) = delete;
    CommandGate& operator=(const CommandGate&) = delete;

    [[nodiscard]] Client newClient() noexcept { return ++lastClient_; }
    /// Hands a request to the cycle. \return why it is refused; empty when its answers will come
    [[nodiscard]] std::string submit(Client client, const std::string& name,
                                     const ControlRequest& request);
    /// What the cycle, or what was made ready for it, has answered to somebody.
    [[nodiscard]] std::optional<Answer> nextAnswer();
    /// He is gone: what moves for him stops, and another one may command.
    void leave(Client client);
    /// To be called often: an owner who is silent loses the machine.
    void watchOwner();
    /// Waits for what is being made ready.
    void finish();

    [[nodiscard]] Client owner() const noexcept { return owner_; }
    /// Empty when nobody operates.
    [[nodiscard]] const std::string& ownerName() const noexcept { return ownerName_; }

private:
    struct Ticket {
        Client client{Nobody};
        std::uint64_t request{0};
        Order order{};
        std::uint16_t target{0};
    };
    /// A fresh program that a thread of its own makes ready: its start may take its time.
    struct Preparation {
        ControlCommand command{};
        std::thread thread;
        std::vector<std::string> problems;
        std::atomic<bool> over{false};
    };
    using Time = std::chrono::steady_clock::time_point;

    [[nodiscard]] std::string commandOf(const ControlRequest& request,
                                        ControlCommand& command) const;
    [[nodiscard]] std::string targetOf(const ControlRequest& request,
                                       ControlCommand& command) const;
    [[nodiscard]] Answer answerTo(const Ticket& ticket, const ControlAnswer& answer) const;
    void prepareProgram(const ControlCommand& command);
    [[nodiscard]] std::optional<Answer> takePrepared();
    [[nodiscard]] std::string claim(Client client, const std::string& name);
    void release();

    MachineControl& control_;
    ProgramStock& stock_;
    std::map<std::uint64_t, Ticket> tickets_;
    std::uint64_t lastTicket_{0};
    std::unique_ptr<Preparation> preparation_;
    Client lastClient_{Nobody};
    Client owner_{Nobody};
    std::string ownerName_;
    Time ownerSeen_{};
    bool leavePending_{false};
};

}  // namespace takt::daemon
