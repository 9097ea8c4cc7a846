#pragma once

#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "takt_process.hpp"

namespace takt::test {

/// A `takt run` that goes on while the test talks to it.
class RunningTakt {
public:
    /// Returns when its control socket answers. \throw std::runtime_error with its output when it
    /// ends before that
    RunningTakt(const std::string& name, std::vector<std::string> arguments,
                const std::vector<std::string>& environment = {});
    ~RunningTakt();
    RunningTakt(const RunningTakt&) = delete;
    RunningTakt& operator=(const RunningTakt&) = delete;

    [[nodiscard]] const std::string& socket() const noexcept { return socket_; }
    [[nodiscard]] const std::string& folder() const noexcept { return folder_; }
    [[nodiscard]] pid_t process() const noexcept { return child_; }
    void signal(int number) const;
    /// Waits for its end.
    ProcessResult end();
    /// Ends it by SIGTERM, and expects just that.
    ProcessResult terminate();
    /// A command for it, as a user gives it.
    [[nodiscard]] ProcessResult tell(std::vector<std::string> arguments) const;

private:
    [[nodiscard]] bool over();

    std::string folder_;
    std::string socketFolder_;
    std::string socket_;
    pid_t child_{-1};
    bool ended_{false};
    ProcessResult result_;
};

/// A client of the control socket that knows its protocol from the documentation only.
class SocketClient {
public:
    using Json = nlohmann::json;

    explicit SocketClient(const std::string& path);
    ~SocketClient();
    SocketClient(const SocketClient&) = delete;
    SocketClient& operator=(const SocketClient&) = delete;

    void sendRaw(const std::string& bytes) const;
    /// \return the id of the request
    int send(Json request);
    /// The next line. \return null when the other end has closed; throws when nothing comes
    Json receive();
    /// The last reply to the request; "accepted" is passed over.
    Json ask(const Json& request);
    /// Waits for the last reply to a request that was sent.
    Json await(int id);
    [[nodiscard]] Json status();
    /// "state" of an axis.
    [[nodiscard]] Json axis(const std::string& name);
    /// Asks for the status, giving no other sign of life, until the axis has come to the state.
    Json awaitState(const std::string& axis, const std::string& state);
    /// All texts of events so far.
    [[nodiscard]] std::vector<std::string> events();
    void close();
    /// Between two questions of the same kind, so that the machine does not take it for a flood.
    static void pause();

private:
    int socket_{-1};
    int lastId_{0};
    std::string received_;
};

}  // namespace takt::test
