#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <takt/daemon/control_messages.hpp>
#include <takt/daemon/control_socket.hpp>
#include <takt/record/output_file.hpp>
#include <thread>
#include <vector>

#include "bridge_door.hpp"
#include "command_gate.hpp"
#include "machine_control.hpp"
#include "rate_limit.hpp"

namespace takt::daemon {

/// Serves the control socket on a thread of its own: status and events for everybody who may
/// connect, commands through the gate. The bridge, where there is one, is served by the same
/// thread. It reaches the cycle through rings and sequence locks only.
class ControlServer {
public:
    static constexpr std::size_t MostClients = 16;
    static constexpr std::size_t MostLine = 4096;  ///< of a request
    static constexpr std::size_t MostUnsent =
        1U << 20U;  ///< then a client that does not read is dropped
    static constexpr std::size_t KeptEvents = 2000;
    /// Of one client; then its requests are refused, but never a stop.
    static constexpr double MostRequestsPerSecond = 500;

    struct Parts {
        const config::MachineConfig& machine;
        ProgramStock& stock;
        MachineControl& control;
        BridgeDoor* bridge;  ///< null: none
    };
    /// Opens the socket and begins to serve. \param commandFile taken commands are written there;
    /// empty: nowhere. \throw std::runtime_error naming what cannot be opened
    ControlServer(const Parts& parts, const std::filesystem::path& socket,
                  const std::filesystem::path& commandFile);
    ~ControlServer();
    ControlServer(const ControlServer&) = delete;
    ControlServer& operator=(const ControlServer&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return socket_.path(); }
    /// Ends the thread; the rest of events and commands is taken over. \return false when the
    /// command file is not complete
    bool finish();

private:
    struct Client {
        int connection{-1};
        int pid{0};
        std::string who;
        std::string received;
        std::string unsent;
        bool gone{false};
        RateLimit rate{MostRequestsPerSecond, std::chrono::steady_clock::now()};
    };
    /// Who waits for a diagnosis to be shown.
    struct Inquiry {
        CommandGate::Client client{CommandGate::Nobody};
        std::uint64_t request{0};
        std::uint32_t number{0};
    };
    void serve();
    void waitForClients();
    void acceptClients();
    void receive(CommandGate::Client number, Client& client);
    void handle(CommandGate::Client number, Client& client, std::string_view line);
    void order(CommandGate::Client number, Client& client, const ControlRequest& request);
    void refuse(Client& client, const ControlRequest& request, std::string why);
    void inquire(CommandGate::Client number, Client& client, const ControlRequest& request);
    void answerInquiries();
    void takeAnswers();
    void takeEvents();
    void takeCommands();
    void serveBridge();
    void sendAll();
    void dropGone();
    void keep(core::CycleNumber cycle, std::string text);
    [[nodiscard]] StatusReport report() const;
    [[nodiscard]] NetworkReport networkReport() const;
    [[nodiscard]] std::vector<EventReport> eventsAfter(std::uint64_t number) const;
    [[nodiscard]] double secondsOf(core::CycleNumber cycle) const;

    Parts parts_;
    ControlSocket socket_;
    std::unique_ptr<record::OutputFile> commandFile_;
    CommandGate gate_;
    std::map<CommandGate::Client, Client> clients_;
    std::vector<Inquiry> inquiries_;
    std::deque<EventReport> events_;
    std::uint64_t lastEvent_{0};
    std::uint64_t commandsLost_{0};
    std::atomic<bool> ending_{false};
    std::thread thread_;
};

}  // namespace takt::daemon
