#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <takt/core/time.hpp>

namespace takt::daemon {

/// Tells a service manager how the run stands (the protocol of sd_notify(3): one datagram to the
/// socket that $NOTIFY_SOCKET names). Without such a manager every call does nothing. Outside the
/// cycle.
class ServiceNotifier {
public:
    ServiceNotifier();
    ~ServiceNotifier();
    ServiceNotifier(const ServiceNotifier&) = delete;
    ServiceNotifier& operator=(const ServiceNotifier&) = delete;

    /// The machine operates.
    void ready(const std::string& status);
    /// It is being taken down; only the first call counts.
    void stopping();
    /// Call often: a sign of life goes out when one is due and cycles have run since the last one.
    /// So a cycle that hangs ends the process, and the drives stop by their own watchdog.
    void alive(core::CycleNumber cycle);

private:
    using Clock = std::chrono::steady_clock;

    void send(std::string_view text) const;

    std::string path_;  ///< empty: nobody listens
    int socket_{-1};
    Clock::duration interval_{0};  ///< of signs of life; 0: none wanted
    Clock::time_point last_{};
    core::CycleNumber lastCycle_{0};
    bool stopping_{false};
};

}  // namespace takt::daemon
