#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>
#include <takt/bridge/command_memory.hpp>
#include <takt/bridge/status_memory.hpp>

#include "dds_node.hpp"

namespace takt::bridge {

/// Carries what the daemon shows to DDS, and commands back.
class Publisher {
public:
    /// All must outlive the object.
    Publisher(StatusReader& status, CommandSender& commands, DdsNode& node)
        : status_{status}, commands_{commands}, node_{node} {}

    /// Publishes what has come since the last call, at most a burst of it, and hands commands over.
    /// \return there is more
    bool step();
    /// How long to rest when there is no more.
    [[nodiscard]] std::chrono::nanoseconds rest() const noexcept;

private:
    bool publishPeriod();
    void publishEvents();
    void publishReplies();
    void handOver();
    void refuse(const CommandRecord& command, std::string_view why);

    StatusReader& status_;
    CommandSender& commands_;
    DdsNode& node_;
    std::optional<EventRecord> event_;  ///< could not be sent yet
    std::optional<ReplyRecord> reply_;
    std::uint64_t published_{0};
};

}  // namespace takt::bridge
