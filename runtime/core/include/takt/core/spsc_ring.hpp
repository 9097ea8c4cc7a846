#pragma once

#include <atomic>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace takt::core {

/// A ring between exactly one producer thread and one consumer thread. Allocates at construction
/// only.
template <typename T>
class SpscRing {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    /// Room for `capacity` items.
    explicit SpscRing(std::size_t capacity) : slots_(capacity + 1) {}

    /// rt. Producer only. \return false, and nothing changes, when full
    bool push(const T& value) noexcept {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        const std::size_t next = (tail + 1 == slots_.size()) ? 0 : tail + 1;
        if (next == head_.load(std::memory_order_acquire)) return false;
        slots_[tail] = value;
        tail_.store(next, std::memory_order_release);
        return true;
    }

    /// rt. Consumer only. \return false when empty
    bool pop(T& value) noexcept {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head == tail_.load(std::memory_order_acquire)) return false;
        value = slots_[head];
        head_.store((head + 1 == slots_.size()) ? 0 : head + 1, std::memory_order_release);
        return true;
    }

private:
    std::vector<T> slots_;
    alignas(64) std::atomic<std::size_t> head_{0};
    alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace takt::core
