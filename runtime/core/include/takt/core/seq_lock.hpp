#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace takt::core {

/// A value written by exactly one thread and read by any number. The writer never waits; a reader
/// whose copy was overtaken by a write tries again. The words are atomic, so that a torn copy is
/// thrown away instead of being undefined.
template <typename T>
class SeqLock {
    static_assert(std::is_trivially_copyable_v<T> && std::is_default_constructible_v<T>);

public:
    SeqLock() noexcept { write(T{}); }
    SeqLock(const SeqLock&) = delete;
    SeqLock& operator=(const SeqLock&) = delete;

    /// rt. Writer only.
    void write(const T& value) noexcept {
        std::array<std::uint64_t, Words> words{};
        std::memcpy(words.data(), static_cast<const void*>(&value), sizeof(T));
        const std::uint64_t number = sequence_.load(std::memory_order_relaxed);
        sequence_.store(number + 1, std::memory_order_relaxed);
        std::atomic_thread_fence(std::memory_order_release);
        for (std::size_t i = 0; i < Words; ++i) {
            words_[i].store(words[i], std::memory_order_relaxed);
        }
        sequence_.store(number + 2, std::memory_order_release);
    }

    /// rt. One attempt. \return false, and nothing changes, when a write was under way
    [[nodiscard]] bool tryRead(T& value) const noexcept {
        const std::uint64_t before = sequence_.load(std::memory_order_acquire);
        if (before % 2 != 0) return false;
        std::array<std::uint64_t, Words> words;
        for (std::size_t i = 0; i < Words; ++i) {
            words[i] = words_[i].load(std::memory_order_relaxed);
        }
        std::atomic_thread_fence(std::memory_order_acquire);
        if (sequence_.load(std::memory_order_relaxed) != before) return false;
        std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
        return true;
    }

    /// Outside the cycle: tries until a whole value was read.
    [[nodiscard]] T read() const noexcept {
        T value{};
        while (!tryRead(value)) {
        }
        return value;
    }

private:
    static constexpr std::size_t Words =
        (sizeof(T) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);

    alignas(64) std::atomic<std::uint64_t> sequence_{0};
    std::array<std::atomic<std::uint64_t>, Words> words_{};
};

}  // namespace takt::core
