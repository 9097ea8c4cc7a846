#pragma once

#include <chrono>
#include <takt/core/time.hpp>

namespace takt::daemon {

/// Lets virtual time follow the wall clock: after each cycle it sleeps until the wall clock has
/// come as far. A late host makes the simulation late and nothing else. Also the wall-clock
/// stopwatch of a run.
class Pace {
public:
    explicit Pace(bool follow) : follow_{follow}, began_{std::chrono::steady_clock::now()} {}

    /// Outside the cycle. \param simulated virtual time since the run began
    void wait(core::Duration simulated) const;
    [[nodiscard]] core::Duration elapsed() const;

private:
    bool follow_;
    std::chrono::steady_clock::time_point began_;
};

}  // namespace takt::daemon
