#pragma once

#include <csignal>

namespace takt::daemon {

/// SIGINT, SIGTERM and SIGHUP as requests to stop, for the lifetime of the object. A closed
/// terminal is such a request too: the machine stops in order, never at once. A closed pipe, a key
/// that suspends
/// (^Z) and a terminal that is somebody else's do nothing: output is not worth a machine that stops
/// dead.
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
    struct sigaction oldPipe_ {};
    struct sigaction oldStop_ {};
    struct sigaction oldTtou_ {};
};

}  // namespace takt::daemon
