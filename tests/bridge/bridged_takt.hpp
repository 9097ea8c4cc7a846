#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "takt_process.hpp"

namespace takt::test {

/// A `takt` that runs beside the test, and its bridge.
class BridgedTakt {
public:
    BridgedTakt(const std::vector<std::string>& arguments, std::string folder);
    ~BridgedTakt();
    BridgedTakt(const BridgedTakt&) = delete;
    BridgedTakt& operator=(const BridgedTakt&) = delete;

    [[nodiscard]] pid_t pid() const { return pid_; }
    /// The process of its bridge; 0 while there is none.
    [[nodiscard]] pid_t bridge() const;
    [[nodiscard]] bool ended();
    /// Waits for its end.
    ProcessResult finish();
    void kill(int signal) const;

private:
    std::string folder_;
    pid_t pid_{0};
    int status_{0};
    bool reaped_{false};
};

/// A machine file that is nobody else's: its name and DDS domain are of this test process, so that
/// tests of other builds do not meet.
struct OwnMachine {
    std::string name;
    std::string file;
    std::string socket;
    unsigned domain{0};
};
/// The sixteen stations of sample 07. \param dds further attributes of <Dds>
OwnMachine ownMachine(const std::string& folder, const std::string& dds = {});

/// Looks every few milliseconds until it is so. \return false after `seconds`
template <typename Condition>
bool waitFor(Condition condition, double seconds);

void pauseFor(double seconds);
double now();

template <typename Condition>
bool waitFor(Condition condition, double seconds) {
    constexpr double interval = 0.005;
    for (const double end = now() + seconds; now() < end; pauseFor(interval)) {
        if (condition()) return true;
    }
    return condition();
}

}  // namespace takt::test
