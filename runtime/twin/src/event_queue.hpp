#pragma once

#include <cstddef>
#include <cstdint>
#include <takt/core/time.hpp>
#include <vector>

namespace takt::twin {

/// What can happen to a simulated device on its own. The order settles events of the same instant.
enum class EventKind : std::uint8_t { Sync0, Watchdog, AlControl, Mailbox, Tick };
inline constexpr std::size_t EventKinds = 5;

/// The events to come, one at most for each device and kind, ordered by (time, device, kind).
/// An indexed binary heap: it allocates at construction only, and moving an event is cheap.
class EventQueue {
public:
    explicit EventQueue(std::size_t devices);

    /// rt. Puts the event at `time`; moves it when it is already pending.
    void schedule(std::size_t device, EventKind kind, core::TrueTime time) noexcept;
    /// rt.
    void cancel(std::size_t device, EventKind kind) noexcept;
    [[nodiscard]] bool pending(std::size_t device, EventKind kind) const noexcept;
    /// rt. Time of the next event; TrueTime::max() when there is none.
    [[nodiscard]] core::TrueTime nextTime() const noexcept {
        return heap_.empty() ? core::TrueTime::max() : time_[heap_[0]];
    }

    struct Event {
        std::size_t device;
        EventKind kind;
        core::TrueTime time;
    };
    /// rt. The next event. It stays in its place while it is handled, so that handling it may just
    /// move it to its next time; `done` takes it out if that did not happen. \pre one is pending
    Event begin() noexcept;
    void done() noexcept;

private:
    using Slot = std::uint32_t;
    static constexpr Slot NotPending = 0xFFFFFFFF;

    [[nodiscard]] bool before(Slot a, Slot b) const noexcept {
        return time_[a] != time_[b] ? time_[a] < time_[b] : a < b;
    }
    void place(std::size_t at, Slot slot) noexcept;
    void siftUp(std::size_t at) noexcept;
    void siftDown(std::size_t at) noexcept;
    void removeAt(std::size_t at) noexcept;

    Slot handled_{NotPending};          ///< between begin and done, until it is scheduled anew
    std::vector<core::TrueTime> time_;  ///< of each slot
    std::vector<Slot> position_;        ///< of each slot in the heap
    std::vector<Slot> heap_;
};

/// The part of the queue that belongs to one device.
class EventPort {
public:
    EventPort(EventQueue& queue, std::size_t device) noexcept : queue_{&queue}, device_{device} {}

    void schedule(EventKind kind, core::TrueTime time) noexcept {
        queue_->schedule(device_, kind, time);
    }
    void cancel(EventKind kind) noexcept { queue_->cancel(device_, kind); }
    [[nodiscard]] bool pending(EventKind kind) const noexcept {
        return queue_->pending(device_, kind);
    }

private:
    EventQueue* queue_;
    std::size_t device_;
};

}  // namespace takt::twin
