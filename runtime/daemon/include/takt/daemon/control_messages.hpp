#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <takt/daemon/network_report.hpp>
#include <vector>

/// What goes over the control socket: one JSON object in a line, both ways. Everything here is
/// plain data; only the encoder knows JSON.
namespace takt::daemon {

/// `{"id":7,"do":"inch","axis":"X","distance":0.1,"velocity":5}`
struct ControlRequest {
    std::uint64_t id{0};  ///< comes back in every reply to it
    std::string verb{};   ///< "status", "events", "network", or an order: "inch", "power-on", …
    std::string axis{};
    std::string program{};
    double distance{0.0};
    double velocity{0.0};
    std::string device{};    ///< name or position, for objects
    std::string object{};    ///< "0x6065:0"
    std::string data{};      ///< of a download: "E8030000", the bytes as on the wire
    bool force{false};       ///< of a download: also while a program runs
    std::uint64_t after{0};  ///< events: those with a higher number
    std::string who{};       ///< how the client calls itself, for "operated by …"
};

/// How far a request has come. Orders get Accepted first when they take time, then their end.
enum class ReplyKind : std::uint8_t { Accepted, Refused, Done, Aborted, Failed };

struct AxisReport {
    std::string name{};
    std::string unit{};
    std::string state{};
    double set{0.0};
    double actual{0.0};
    double velocity{0.0};
    double lag{0.0};
    bool powered{false};
    bool homed{false};
    bool needsEnableEdge{false};
    std::string error{};   ///< in words; empty = none
    std::string holder{};  ///< program that holds it; empty = none
};

struct GroupReport {
    std::string name{};
    std::string unit{};  ///< of path length
    std::string state{};
    double path{0.0};      ///< length travelled on paths so far
    double velocity{0.0};  ///< along the path
    std::uint64_t queued{0};
    std::string error{};  ///< in words; empty = none
};

struct WatchReport {
    std::string name{};
    double value{0.0};
};

struct ProgramReport {
    std::string name{};
    std::string state{};
    std::vector<WatchReport> watches;
};

struct StatusReport {
    std::string machine{};
    std::int64_t pid{0};
    std::uint64_t cycle{0};
    double seconds{0.0};
    std::string phase{};
    std::string network{};
    std::uint64_t framesSent{0};
    std::uint64_t framesLost{0};
    std::uint64_t framesLate{0};
    std::uint64_t workingCounterErrors{0};
    std::string machineStop{};         ///< its cause; empty = not stopped
    std::string owner{};               ///< who operates; empty = nobody
    std::int64_t bridgeProcess{0};     ///< 0 = there is none now
    std::uint64_t bridgeStarts{0};     ///< 0 = the machine has no bridge
    std::uint64_t bridgePublished{0};  ///< status samples since its last start
    std::vector<AxisReport> axes;
    std::vector<GroupReport> groups;
    std::vector<ProgramReport> programs;
};

struct EventReport {
    std::uint64_t number{0};
    std::uint64_t cycle{0};
    double seconds{0.0};
    std::string text{};
};

struct ControlReply {
    std::uint64_t id{0};
    ReplyKind kind{ReplyKind::Done};
    std::string error{};  ///< why refused or failed
    std::uint64_t cycle{0};
    std::string data{};          ///< of an upload: the bytes as on the wire
    std::uint64_t abortCode{0};  ///< with which a device refused an object
    std::optional<StatusReport> status{};
    std::optional<std::vector<EventReport>> events{};
    std::optional<NetworkReport> network{};
};

/// One line without its end. \return empty, with `error` saying why, when the line is no such thing
[[nodiscard]] std::optional<ControlRequest> parseRequest(std::string_view line, std::string& error);
[[nodiscard]] std::optional<ControlReply> parseReply(std::string_view line, std::string& error);
/// One line with its end.
[[nodiscard]] std::string encode(const ControlRequest& request);
[[nodiscard]] std::string encode(const ControlReply& reply);

}  // namespace takt::daemon
