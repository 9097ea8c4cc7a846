#include "remote.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <takt/daemon/control_socket.hpp>

namespace takt::cli {

namespace {

using namespace std::chrono_literals;

/// Three signs of life within the time after which the machine stops a motion by itself.
constexpr auto HeartbeatEvery = 30ms;
constexpr auto ReplyTimeout = 5s;

std::filesystem::path onlyMachine() {
    const auto running = daemon::runningMachines();
    if (running.empty())
        throw std::runtime_error{"no machine runs here; do: takt run, or name its --socket"};
    if (running.size() == 1) return running.front();
    std::string list;
    for (const auto& path : running) list += "\n  " + path.string();
    throw std::runtime_error{"several machines run here; do: choose one with --socket" + list};
}

int connectTo(const std::filesystem::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = path.string();
    if (name.size() >= sizeof(address.sun_path))
        throw std::runtime_error{name + ": the path is too long"};
    std::memcpy(address.sun_path, name.c_str(), name.size() + 1);
    const int connection = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connection >= 0 &&
        ::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
        return connection;
    }
    const std::string why = std::strerror(errno);
    if (connection >= 0) ::close(connection);
    throw std::runtime_error{fmt::format("{}: {}; is the machine running?", name, why)};
}

}  // namespace

int noMachine(const std::string& why) {
    fmt::print(stderr, "{}\n", why);
    return 2;
}

Remote::Remote(const RemoteOptions& options, std::string who)
    : socket_{connectTo(options.socket.empty() ? onlyMachine() : options.socket)},
      who_{std::move(who)} {}

Remote::~Remote() {
    ::close(socket_);
}

std::uint64_t Remote::send(daemon::ControlRequest request) {
    request.id = ++lastId_;
    request.who = who_;
    const std::string line = encode(request);
    for (std::size_t sent = 0; sent < line.size();) {
        const ssize_t count = ::send(socket_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) throw std::runtime_error{"the machine has gone"};
        sent += static_cast<std::size_t>(count);
    }
    return request.id;
}

void Remote::heartbeat() {
    daemon::ControlRequest request;
    request.verb = "heartbeat";
    send(std::move(request));
}

std::optional<std::string> Remote::takeLine() {
    const std::size_t end = received_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    return line;
}

std::optional<daemon::ControlReply> Remote::receive(std::chrono::milliseconds patience) {
    auto line = takeLine();
    if (!line) {
        pollfd wait{socket_, POLLIN, 0};
        if (::poll(&wait, 1, static_cast<int>(patience.count())) <= 0) return std::nullopt;
        std::array<char, 16384> buffer{};
        const ssize_t count = ::recv(socket_, buffer.data(), buffer.size(), 0);
        if (count < 0 && errno == EINTR) return std::nullopt;
        if (count <= 0) throw std::runtime_error{"the machine has gone"};
        received_.append(buffer.data(), static_cast<std::size_t>(count));
        line = takeLine();
        if (!line) return std::nullopt;
    }
    lastLine_ = *line;
    std::string error;
    auto reply = daemon::parseReply(*line, error);
    if (!reply) throw std::runtime_error{"the machine answers in an unknown way: " + error};
    return reply;
}

std::optional<daemon::ControlReply> Remote::ask(const daemon::ControlRequest& request,
                                                const std::function<bool()>& keepOn) {
    const std::uint64_t id = send(request);
    const bool question =
        request.verb == "status" || request.verb == "events" || request.verb == "network";
    auto last = std::chrono::steady_clock::now();
    while (!keepOn || keepOn()) {
        if (auto reply = receive(HeartbeatEvery)) {
            last = std::chrono::steady_clock::now();
            const bool mine = reply->id == id || reply->id == 0;
            if (mine && reply->kind != daemon::ReplyKind::Accepted) return reply;
        }
        if (!question) {
            heartbeat();
        } else if (std::chrono::steady_clock::now() - last > ReplyTimeout) {
            throw std::runtime_error{"the machine does not answer"};
        }
    }
    return std::nullopt;
}

daemon::StatusReport Remote::status() {
    daemon::ControlRequest request;
    request.verb = "status";
    const auto reply = ask(request);
    if (!reply || !reply->status) {
        throw std::runtime_error{reply ? reply->error : std::string{"the machine does not answer"}};
    }
    return *reply->status;
}

daemon::NetworkReport Remote::network() {
    daemon::ControlRequest request;
    request.verb = "network";
    const auto reply = ask(request);
    if (!reply->network) throw std::runtime_error{reply->error};
    return *reply->network;
}

int runOrder(const OrderOptions& options) {
    try {
        Remote remote{options.remote, "takt " + options.request.verb};
        const auto reply = remote.ask(options.request);
        if (options.remote.json) {
            fmt::print("{}\n", remote.lastLine());
        } else if (reply->kind != daemon::ReplyKind::Done) {
            fmt::print(stderr, "{}\n",
                       reply->error.empty() ? "another command took its place" : reply->error);
        }
        return reply->kind == daemon::ReplyKind::Done ? 0 : 1;
    } catch (const std::runtime_error& error) {
        return noMachine(error.what());
    }
}

int runEvents(const EventsOptions& options) {
    try {
        Remote remote{options.remote, "takt events"};
        daemon::ControlRequest request;
        request.verb = "events";
        do {
            const auto reply = remote.ask(request);
            if (!reply->events) throw std::runtime_error{reply->error};
            for (const daemon::EventReport& event : *reply->events) {
                request.after = event.number;
                if (!options.remote.json) {
                    fmt::print("{:>12.6f} s  cycle {:>9}  {}\n", event.seconds, event.cycle,
                               event.text);
                }
            }
            if (options.remote.json && !reply->events->empty())
                fmt::print("{}\n", remote.lastLine());
            std::fflush(stdout);
            if (options.follow) ::poll(nullptr, 0, 100);
        } while (options.follow);
        return 0;
    } catch (const std::runtime_error& error) {
        return noMachine(error.what());
    }
}

}  // namespace takt::cli
