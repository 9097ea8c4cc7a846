#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// How the network of a running machine is doing: plain data, for tables and for the control
/// socket.
namespace takt::daemon {

/// Times that were measured in every cycle, in nanoseconds.
struct TimesReport {
    struct Bin {
        std::uint64_t upTo{0};
        std::uint64_t count{0};
    };
    std::uint64_t count{0};
    std::uint64_t least{0};
    std::uint64_t mean{0};
    std::uint64_t mostOf99{0};   ///< not exceeded by 99 % of the cycles
    std::uint64_t mostOf999{0};  ///< by 99.9 %
    std::uint64_t most{0};
    std::vector<Bin> bins;  ///< that are not empty, ascending, each twice as wide as the one before
};

/// One device as the master sees it now.
struct DeviceReport {
    std::uint64_t position{0};  ///< from 0, in frame order
    std::uint64_t station{0};
    std::string name{};  ///< in the machine file
    std::string type{};
    std::string device{};  ///< as its maker calls it
    std::string file{};    ///< that describes it
    std::uint64_t vendor{0};
    std::uint64_t product{0};
    std::uint64_t revision{0};
    std::string state{};  ///< "OP"; "NONE": does not answer
    bool error{false};
    std::uint64_t alStatusCode{0};
    std::string problem{};      ///< AL status in words; empty: none
    std::uint64_t group{0};     ///< datagram that carries its process data
    std::uint64_t expected{0};  ///< working counter of that datagram
    std::uint64_t lastSeen{0};
    std::uint64_t wrong{0};        ///< cycles with another working counter
    std::uint64_t lost{0};         ///< cycles without a reply
    std::uint64_t lostInRow{0};    ///< cycles without valid inputs, now
    std::string workingCounter{};  ///< what is wrong with it in words; empty: nothing ever was
    std::uint64_t emergencies{0};
    std::uint64_t lastEmergency{0};  ///< error code of the last one
};

struct NetworkReport {
    std::string machine{};
    std::uint64_t cycle{0};
    std::string state{};
    std::string problem{};  ///< empty: none

    std::uint64_t framesSent{0};
    std::uint64_t framesLost{0};
    std::uint64_t framesLate{0};
    std::uint64_t framesDuplicate{0};
    std::uint64_t framesMalformed{0};
    std::uint64_t framesForeign{0};
    std::uint64_t sendFailures{0};
    std::uint64_t workingCounterErrors{0};

    std::uint64_t missedCycles{0};  ///< grid points that were skipped
    std::uint64_t lateWakeUps{0};   ///< how often that happened, and by whom:
    std::uint64_t missedByHost{0};
    std::uint64_t missedByBus{0};
    std::uint64_t missedByPrograms{0};
    std::uint64_t missedByAxes{0};

    bool clockLocked{false};
    std::uint64_t relocks{0};
    double driftPpm{0.0};  ///< of the controller's clock against the reference

    TimesReport lateness{};    ///< planned wake-up to the real one
    TimesReport reply{};       ///< wake-up until the replies were there
    TimesReport execution{};   ///< wake-up to the end of the cycle
    TimesReport phaseError{};  ///< off the SYNC0 grid while locked
    std::vector<DeviceReport> devices;
};

/// For people: the summary of frames and clocks in one line.
[[nodiscard]] std::string frameSummary(const NetworkReport& network);
/// Missed cycles by culprit, and the times with their distribution, line by line.
[[nodiscard]] std::vector<std::string> timeTable(const NetworkReport& network);
/// One line for each device, under a heading.
[[nodiscard]] std::vector<std::string> deviceTable(const NetworkReport& network);

}  // namespace takt::daemon
