#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <takt/core/spsc_ring.hpp>
#include <takt/core/time.hpp>
#include <vector>

namespace takt::record {

/// What happened, as it leaves the cycle: numbers only. The sentence is written elsewhere.
struct Event {
    core::CycleNumber cycle{0};
    std::uint16_t id{0};      ///< an EventText::id
    std::uint16_t source{0};  ///< which axis, slave or program; index into the source names
    std::array<double, 4> numbers{};
};

/// Events from one thread of the cycle to one reader.
class EventLog {
public:
    explicit EventLog(std::size_t capacity) : ring_{capacity} {}

    /// rt. Producer only. When full the event is counted and lost.
    void add(const Event& event) noexcept {
        if (!ring_.push(event)) dropped_.fetch_add(1, std::memory_order_relaxed);
    }
    /// Reader only. \return false when there is none
    bool next(Event& event) noexcept { return ring_.pop(event); }
    [[nodiscard]] std::uint64_t dropped() const noexcept {
        return dropped_.load(std::memory_order_relaxed);
    }

private:
    core::SpscRing<Event> ring_;
    std::atomic<std::uint64_t> dropped_{0};
};

/// The sentence behind an event id. `{0}` to `{3}` stand for the numbers, `{x0}` to `{x3}` for the
/// same in hexadecimal with four digits or more.
struct EventText {
    std::uint16_t id{0};
    std::string_view sentence;
};

/// Turns events into lines of text: `cycle 1234 X: following error 2.5 mm, limit 2 mm`.
class EventFormatter {
public:
    /// `sources` in the order of Event::source. The views must stay valid.
    EventFormatter(std::vector<EventText> texts, std::vector<std::string> sources);

    /// An unknown id or source is shown by its number; never fails.
    [[nodiscard]] std::string format(const Event& event) const;

private:
    std::vector<EventText> texts_;
    std::vector<std::string> sources_;
};

}  // namespace takt::record
