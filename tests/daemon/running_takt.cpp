#include "running_takt.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace takt::test {

namespace {

/// So long nothing may stay silent, however slow the computer.
constexpr int Patience = 60'000;

int connectTo(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    const int connection = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0)
        return connection;
    ::close(connection);
    return -1;
}

}  // namespace

RunningTakt::RunningTakt(const std::string& name, std::vector<std::string> arguments,
                         const std::vector<std::string>& environment)
    : folder_{freshFolder(name)} {
    std::string pattern = "/tmp/takt-test-XXXXXX";  // a socket's path must be short
    socketFolder_ = ::mkdtemp(pattern.data());
    socket_ = socketFolder_ + "/s";
    arguments.insert(arguments.end(), {"--socket", socket_});
    child_ = startTakt(arguments, folder_, folder_ + "/output.txt", environment);
    for (;;) {
        if (over())
            throw std::runtime_error{"takt has ended: " + readFile(folder_ + "/output.txt")};
        const int connection = connectTo(socket_);
        if (connection >= 0) {
            ::close(connection);
            return;
        }
        ::poll(nullptr, 0, 5);
    }
}

RunningTakt::~RunningTakt() {
    if (!ended_) {
        signal(SIGKILL);
        end();
    }
    std::filesystem::remove_all(socketFolder_);
}

bool RunningTakt::over() {
    int status = 0;
    if (::waitpid(child_, &status, WNOHANG) == 0) return false;
    ended_ = true;
    return true;
}

void RunningTakt::signal(int number) const {
    if (!ended_) ::kill(child_, number);
}

ProcessResult RunningTakt::end() {
    if (!ended_) {
        int status = 0;
        ::waitpid(child_, &status, 0);
        ended_ = true;
        result_.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        result_.output = readFile(folder_ + "/output.txt");
    }
    return result_;
}

ProcessResult RunningTakt::terminate() {
    signal(SIGTERM);
    ProcessResult result = end();
    EXPECT_EQ(result.exitCode, 128 + SIGTERM) << result.output;
    return result;
}

ProcessResult RunningTakt::tell(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--socket", socket_});
    return runTakt(arguments, folder_);
}

SocketClient::SocketClient(const std::string& path) : socket_{connectTo(path)} {
    if (socket_ < 0) throw std::runtime_error{path + ": " + std::strerror(errno)};
}

SocketClient::~SocketClient() {
    close();
}

void SocketClient::pause() {
    constexpr int milliseconds = 10;
    ::poll(nullptr, 0, milliseconds);
}

void SocketClient::close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
}

void SocketClient::sendRaw(const std::string& bytes) const {
    for (std::size_t sent = 0; sent < bytes.size();) {
        const ssize_t count =
            ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (count <= 0) return;
        sent += static_cast<std::size_t>(count);
    }
}

int SocketClient::send(Json request) {
    request["id"] = ++lastId_;
    sendRaw(request.dump() + "\n");
    return lastId_;
}

SocketClient::Json SocketClient::receive() {
    for (;;) {
        if (const std::size_t end = received_.find('\n'); end != std::string::npos) {
            Json line = Json::parse(received_.substr(0, end));
            received_.erase(0, end + 1);
            return line;
        }
        pollfd wait{socket_, POLLIN, 0};
        if (::poll(&wait, 1, Patience) <= 0) throw std::runtime_error{"nothing comes"};
        std::array<char, 65536> buffer{};
        const ssize_t count = ::recv(socket_, buffer.data(), buffer.size(), 0);
        if (count <= 0) return nullptr;
        received_.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

SocketClient::Json SocketClient::await(int id) {
    for (;;) {
        Json reply = receive();
        if (reply.is_null()) throw std::runtime_error{"the machine has closed"};
        if (reply["id"] == id && reply["is"] != "accepted") return reply;
    }
}

SocketClient::Json SocketClient::ask(const Json& request) {
    return await(send(request));
}

SocketClient::Json SocketClient::status() {
    return ask({{"do", "status"}}).at("status");
}

SocketClient::Json SocketClient::axis(const std::string& name) {
    const Json all = status();
    for (const Json& axis : all.at("axes")) {
        if (axis.at("name") == name) return axis;
    }
    throw std::runtime_error{"no axis " + name};
}

SocketClient::Json SocketClient::awaitState(const std::string& name, const std::string& state) {
    for (;;) {
        Json found = axis(name);
        if (found.at("state") == state) return found;
        pause();
    }
}

std::vector<std::string> SocketClient::events() {
    std::vector<std::string> texts;
    const Json reply = ask({{"do", "events"}});
    for (const Json& event : reply.at("events")) texts.push_back(event.at("text"));
    return texts;
}

}  // namespace takt::test
