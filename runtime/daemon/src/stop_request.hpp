#pragma once

#include <csignal>

namespace takt::daemon {

/// SIGINT, SIGTERM and SIGHUP as requests to stop, for the lifetime of the object. A closed terminal is
/// such a request too: the machine stops in order, never at once.
class StopRequest {
public:
    StopRequest();
    ~StopRequest();
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;

    /// rt. Signals so far: one asks for a controlled stop, more for a quick stop.
    [[nodiscard]] int count() const noexcept;
    /// rt. Number of the first signal, 0 when none came.
    [[nodiscard]] int signal() const noexcept;

private:
    struct sigaction oldInt_ {};
    struct sigaction oldTerm_ {};
    struct sigaction oldHup_ {};
};

}  // namespace takt::daemon
