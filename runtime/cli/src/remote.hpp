#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <takt/daemon/control_messages.hpp>

namespace takt::cli {

/// How the commands for a running machine find it and print.
struct RemoteOptions {
    std::filesystem::path socket;  ///< empty: the only machine that runs
    bool json{false};
};

/// A connection to a running machine. Every function that waits throws std::runtime_error, in words
/// for the user, when the machine cannot be reached or goes away.
class Remote {
public:
    explicit Remote(const RemoteOptions& options, std::string who);
    ~Remote();
    Remote(const Remote&) = delete;
    Remote& operator=(const Remote&) = delete;

    /// Sends a request. \return its id
    std::uint64_t send(daemon::ControlRequest request);
    /// A sign of life; nothing comes back.
    void heartbeat();
    /// The next reply that has come, waiting at most `patience` for one.
    std::optional<daemon::ControlReply> receive(std::chrono::milliseconds patience);
    /// Sends and waits for the end of the request, giving signs of life meanwhile.
    /// \param keepOn asked between two signs of life; false: waits no longer
    std::optional<daemon::ControlReply> ask(const daemon::ControlRequest& request,
                                            const std::function<bool()>& keepOn = {});
    [[nodiscard]] daemon::StatusReport status();
    [[nodiscard]] daemon::NetworkReport network();
    /// The line of the last reply as it came, without its end.
    [[nodiscard]] const std::string& lastLine() const noexcept { return lastLine_; }
    [[nodiscard]] int descriptor() const noexcept { return socket_; }

private:
    [[nodiscard]] std::optional<std::string> takeLine();

    int socket_{-1};
    std::string who_;
    std::string received_;
    std::string lastLine_;
    std::uint64_t lastId_{0};
};

/// What one of the small commands asks for.
struct OrderOptions {
    RemoteOptions remote;
    daemon::ControlRequest request;
};

// Each prints its own errors. \return the exit code: 0 done, 1 refused or failed, 2 no machine
/// `takt power|reset|home|program|stop`
int runOrder(const OrderOptions& options);

struct WatchOptions {
    RemoteOptions remote;
    bool once{false};
};
/// `takt watch`
int runWatch(const WatchOptions& options);

struct EventsOptions {
    RemoteOptions remote;
    bool follow{false};
};
/// `takt events`
int runEvents(const EventsOptions& options);

struct DiagOptions {
    RemoteOptions remote;
};
/// `takt diag`
int runDiag(const DiagOptions& options);

struct JogOptions {
    RemoteOptions remote;
    std::string axis;
    double distance{1.0};
    double velocity{10.0};
};
/// `takt jog`
int runJog(const JogOptions& options);

/// Says what went wrong on stderr. \return the exit code for it
int noMachine(const std::string& why);

}  // namespace takt::cli
