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

#include "machine_control.hpp"
#include "rate_limit.hpp"

namespace takt::daemon {

/// Serves the control socket on a thread of its own: status and events for everybody who may
/// connect, commands for one owner at a time. It reaches the cycle through rings and sequence locks
/// only.
///
/// Owner is who commands first, until he leaves or is silent for OwnerTime. Stopping is open to
/// all.
class ControlServer {
public:
    static constexpr std::chrono::seconds OwnerTime{1};
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
    struct Ticket {
        std::uint64_t client{0};
        std::uint64_t request{0};
        Order order{};
        std::uint16_t target{0};
    };
    /// Who waits for a diagnosis to be shown.
    struct Inquiry {
        std::uint64_t client{0};
        std::uint64_t request{0};
        std::uint32_t number{0};
    };
    /// A fresh program that a thread of its own makes ready: its start may take its time.
    struct Preparation {
        ControlCommand command{};
        std::thread thread;
        std::vector<std::string> problems;
        std::atomic<bool> over{false};
    };
    using Time = std::chrono::steady_clock::time_point;

    void serve();
    void waitForClients();
    void acceptClients();
    void receive(std::uint64_t number, Client& client);
    void handle(std::uint64_t number, Client& client, std::string_view line);
    void order(std::uint64_t number, Client& client, const ControlRequest& request);
    [[nodiscard]] std::string commandOf(const ControlRequest& request,
                                        ControlCommand& command) const;
    [[nodiscard]] std::string targetOf(const ControlRequest& request,
                                       ControlCommand& command) const;
    [[nodiscard]] std::string claim(std::uint64_t number, const Client& client);
    void refuse(Client& client, const ControlRequest& request, std::string why);
    void prepareProgram(const ControlCommand& command);
    void takePrepared();
    void inquire(std::uint64_t number, Client& client, const ControlRequest& request);
    void answerInquiries();
    void takeAnswers();
    void takeEvents();
    void takeCommands();
    void watchOwner();
    void sendAll();
    void dropGone();
    void leave();
    [[nodiscard]] StatusReport report() const;
    [[nodiscard]] NetworkReport networkReport() const;
    [[nodiscard]] std::vector<EventReport> eventsAfter(std::uint64_t number) const;
    [[nodiscard]] double secondsOf(core::CycleNumber cycle) const;
    [[nodiscard]] std::string ownerName() const;

    Parts parts_;
    ControlSocket socket_;
    std::unique_ptr<record::OutputFile> commandFile_;
    std::map<std::uint64_t, Client> clients_;
    std::uint64_t lastClient_{0};
    std::map<std::uint64_t, Ticket> tickets_;
    std::vector<Inquiry> inquiries_;
    std::unique_ptr<Preparation> preparation_;
    std::uint64_t lastTicket_{0};
    std::uint64_t owner_{0};  ///< 0 = nobody
    Time ownerSeen_{};
    bool leavePending_{false};
    std::deque<EventReport> events_;
    std::uint64_t lastEvent_{0};
    std::uint64_t commandsLost_{0};
    std::atomic<bool> ending_{false};
    std::thread thread_;
};

}  // namespace takt::daemon
