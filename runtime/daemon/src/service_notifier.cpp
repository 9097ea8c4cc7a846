#include "service_notifier.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace takt::daemon {

namespace {

/// \return 0 when there is no such number
std::int64_t numberIn(const char* variable) {
    const char* const text = std::getenv(variable);
    if (text == nullptr) return 0;
    const std::string_view view{text};
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(view.data(), view.data() + view.size(), value);
    return error == std::errc{} && end == view.data() + view.size() ? value : 0;
}

}  // namespace

ServiceNotifier::ServiceNotifier() {
    const char* const path = std::getenv("NOTIFY_SOCKET");
    if (path == nullptr || (path[0] != '/' && path[0] != '@')) return;
    path_ = path;
    if (path_.size() >= sizeof sockaddr_un{}.sun_path) {
        path_.clear();
        return;
    }
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    // The watchdog may be meant for another process of the same service.
    const std::int64_t whose = numberIn("WATCHDOG_PID");
    const std::int64_t time = numberIn("WATCHDOG_USEC");
    if (time > 0 && (whose == 0 || whose == getpid())) {
        interval_ = std::chrono::microseconds{time} / 2;
    }
}

ServiceNotifier::~ServiceNotifier() {
    if (socket_ >= 0) ::close(socket_);
}

void ServiceNotifier::ready(const std::string& status) {
    send("READY=1\nSTATUS=" + status);
}

void ServiceNotifier::stopping() {
    if (stopping_) return;
    stopping_ = true;
    send("STOPPING=1");
}

void ServiceNotifier::alive(core::CycleNumber cycle) {
    if (interval_ == Clock::duration{0} || cycle == lastCycle_) return;
    const Clock::time_point now = Clock::now();
    if (now - last_ < interval_) return;
    last_ = now;
    lastCycle_ = cycle;
    send("WATCHDOG=1");
}

void ServiceNotifier::send(std::string_view text) const {
    if (socket_ < 0) return;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.copy(address.sun_path, sizeof address.sun_path - 1);
    if (path_[0] == '@') address.sun_path[0] = '\0';  // an abstract name
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path_.size());
    // A manager that does not listen must not stop a machine.
    static_cast<void>(::sendto(socket_, text.data(), text.size(), MSG_NOSIGNAL,
                               reinterpret_cast<const sockaddr*>(&address), size));
}

}  // namespace takt::daemon
