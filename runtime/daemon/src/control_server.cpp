#include "control_server.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

#include "command_file.hpp"
#include "realtime_thread.hpp"

namespace takt::daemon {

namespace {

using namespace std::chrono_literals;

/// The cycle cannot wake this thread without a system call, so it looks for answers by itself.
constexpr std::chrono::milliseconds LookAfter = 5ms;

/// Signals are for the thread that runs the machine.
void blockSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

}  // namespace

ControlServer::ControlServer(const Parts& parts, const std::filesystem::path& socket,
                             const std::filesystem::path& commandFile)
    : parts_{parts}, socket_{socket, parts.machine.name}, gate_{parts.control, parts.stock} {
    if (!commandFile.empty()) commandFile_ = std::make_unique<record::OutputFile>(commandFile);
    // The thread inherits the mask: no signal can reach it before it has set its own.
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    thread_ = std::thread{[this] { serve(); }};
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

ControlServer::~ControlServer() {
    static_cast<void>(finish());
}

bool ControlServer::finish() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
    takeCommands();
    const bool lost = parts_.control.rings().takenLost.load(std::memory_order_relaxed) > 0;
    return !commandFile_ || (commandFile_->flush() && !lost);
}

void ControlServer::serve() {
    dropCapabilities();
    blockSignals();
    while (!ending_) {
        waitForClients();
        takeAnswers();
        answerInquiries();
        parts_.stock.clear();
        takeEvents();
        takeCommands();
        serveBridge();
        gate_.watchOwner();
        sendAll();
        dropGone();
    }
    gate_.finish();
    takeAnswers();
    takeEvents();
    sendAll();
    if (parts_.bridge != nullptr) parts_.bridge->close();
    for (auto& [number, client] : clients_) ::close(client.connection);
    clients_.clear();
}

void ControlServer::waitForClients() {
    std::vector<pollfd> waits{{socket_.descriptor(), POLLIN, 0}};
    std::vector<CommandGate::Client> numbers;
    for (const auto& [number, client] : clients_) {
        const auto wanted = static_cast<short>(client.unsent.empty() ? POLLIN : POLLIN | POLLOUT);
        waits.push_back({client.connection, wanted, 0});
        numbers.push_back(number);
    }
    if (::poll(waits.data(), waits.size(), static_cast<int>(LookAfter.count())) <= 0) return;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if ((waits[i + 1].revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
            receive(numbers[i], clients_[numbers[i]]);
        }
    }
    if ((waits[0].revents & POLLIN) != 0) acceptClients();
}

void ControlServer::acceptClients() {
    const int connection =
        ::accept4(socket_.descriptor(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (connection < 0) return;
    const Peer peer = peerOf(connection);
    if (!peer.allowed || clients_.size() >= MostClients) {
        ControlReply reply{.kind = ReplyKind::Refused};
        reply.error = peer.allowed ? "too many clients"
                                   : "only the owner of this machine and its group may connect";
        const std::string line = encode(reply);
        static_cast<void>(
            ::send(connection, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
        ::close(connection);
        return;
    }
    Client client;
    client.connection = connection;
    client.pid = peer.pid;
    clients_.emplace(gate_.newClient(), std::move(client));
}

void ControlServer::receive(CommandGate::Client number, Client& client) {
    std::array<char, 4096> buffer{};
    const ssize_t count = ::recv(client.connection, buffer.data(), buffer.size(), 0);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) client.gone = true;
    if (count <= 0) return;
    client.received.append(buffer.data(), static_cast<std::size_t>(count));
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = client.received.find('\n', begin)) != std::string::npos;
         begin = end + 1) {
        handle(number, client, std::string_view{client.received}.substr(begin, end - begin));
    }
    client.received.erase(0, begin);
    if (client.received.size() > MostLine) {
        refuse(client, {}, fmt::format("a request is longer than {} characters", MostLine));
        client.received.clear();
        client.gone = true;
    }
}

void ControlServer::handle(CommandGate::Client number, Client& client, std::string_view line) {
    std::string error;
    const auto request = parseRequest(line, error);
    if (!request) return refuse(client, {}, std::move(error));
    if (!request->who.empty()) client.who = request->who.substr(0, 32);
    const bool stops = request->verb == name(Order::MachineStop) ||
                       request->verb == name(Order::Halt) || request->verb == name(Order::Leave);
    if (!client.rate.take(std::chrono::steady_clock::now()) && !stops) {
        return refuse(
            client, *request,
            fmt::format("too many requests; allowed: {:.0f} in a second", MostRequestsPerSecond));
    }
    ControlReply reply{.id = request->id};
    if (request->verb == "status") {
        reply.status = report();
    } else if (request->verb == "events") {
        takeEvents();
        reply.events = eventsAfter(request->after);
    } else if (request->verb == "network") {
        return inquire(number, client, *request);
    } else {
        return order(number, client, *request);
    }
    client.unsent += encode(reply);
}

void ControlServer::refuse(Client& client, const ControlRequest& request, std::string why) {
    client.unsent +=
        encode(ControlReply{.id = request.id, .kind = ReplyKind::Refused, .error = std::move(why)});
}

void ControlServer::order(CommandGate::Client number, Client& client,
                          const ControlRequest& request) {
    const std::string name =
        fmt::format("{} (process {})", client.who.empty() ? "a client" : client.who, client.pid);
    if (std::string why = gate_.submit(number, name, request); !why.empty())
        refuse(client, request, std::move(why));
}

void ControlServer::inquire(CommandGate::Client number, Client& client,
                            const ControlRequest& request) {
    const RunPhase phase = parts_.control.board().run.read().phase;
    if (phase == RunPhase::BringUp || phase == RunPhase::Over)
        return refuse(client, request, "no cycle runs: the network is brought up, or the run ends");
    if (inquiries_.size() >= MostClients) return refuse(client, request, "too many at once");
    inquiries_.push_back({number, request.id, parts_.control.diagnosis().ask()});
}

void ControlServer::answerInquiries() {
    std::erase_if(inquiries_, [this](const Inquiry& inquiry) {
        const auto client = clients_.find(inquiry.client);
        if (client == clients_.end()) return true;
        if (!parts_.control.diagnosis().shown(inquiry.number)) return false;
        ControlReply reply{.id = inquiry.request};
        reply.network = networkReport();
        client->second.unsent += encode(reply);
        return true;
    });
}

void ControlServer::takeAnswers() {
    while (const auto answer = gate_.nextAnswer()) {
        if (parts_.bridge != nullptr && parts_.bridge->answer(answer->client, answer->reply)) {
            continue;
        }
        const auto client = clients_.find(answer->client);
        if (client != clients_.end()) client->second.unsent += encode(answer->reply);
    }
}

void ControlServer::takeEvents() {
    record::Event event;
    while (parts_.control.rings().events.next(event)) {
        keep(event.cycle, text(event, parts_.control.names()));
    }
}

/// One more event, for all doors.
void ControlServer::keep(core::CycleNumber cycle, std::string text) {
    events_.push_back({++lastEvent_, cycle, secondsOf(cycle), std::move(text)});
    if (events_.size() > KeptEvents) events_.pop_front();
    if (parts_.bridge != nullptr) parts_.bridge->tell(events_.back());
}

void ControlServer::serveBridge() {
    if (parts_.bridge == nullptr) return;
    const core::CycleNumber cycle = parts_.control.board().run.read().cycle;
    std::string change = parts_.bridge->serve(gate_, cycle);
    if (!change.empty()) keep(cycle, std::move(change));
}

void ControlServer::takeCommands() {
    TakenCommand taken;
    while (parts_.control.rings().taken.pop(taken)) {
        if (commandFile_) commandFile_->write(formatCommand(taken, parts_.control.names()));
    }
}

void ControlServer::sendAll() {
    for (auto& [number, client] : clients_) {
        if (client.unsent.empty()) continue;
        const ssize_t sent =
            ::send(client.connection, client.unsent.data(), client.unsent.size(), MSG_NOSIGNAL);
        if (sent > 0) client.unsent.erase(0, static_cast<std::size_t>(sent));
        const bool broken = sent < 0 && errno != EAGAIN && errno != EINTR;
        if (broken || client.unsent.size() > MostUnsent) client.gone = true;
    }
}

void ControlServer::dropGone() {
    for (auto client = clients_.begin(); client != clients_.end();) {
        if (!client->second.gone) {
            ++client;
            continue;
        }
        gate_.leave(client->first);
        ::close(client->second.connection);
        client = clients_.erase(client);
    }
}

}  // namespace takt::daemon
