#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>
#include <takt/core/seq_lock.hpp>
#include <type_traits>

namespace takt::bridge {

/// How a ring lies in memory: a count, then its slots, each a sequence lock.
template <typename T>
struct RingLayout {
    struct Entry {
        std::uint64_t number{0};
        T value{};
    };
    struct Head {
        alignas(64) std::atomic<std::uint64_t> count{0};
    };
    using Slot = core::SeqLock<Entry>;
    static_assert(std::is_trivially_copyable_v<T>);
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "shared between processes");
    static_assert(alignof(Slot) == alignof(Head) && sizeof(Head) % alignof(Slot) == 0);

    [[nodiscard]] static constexpr std::size_t bytes(std::size_t depth) noexcept {
        return sizeof(Head) + depth * sizeof(Slot);
    }
};

/// The writing end of a ring in shared memory. It waits for nobody: readers that fall behind by
/// more than the depth lose the oldest.
template <typename T>
class RingWriter {
    using Layout = RingLayout<T>;

public:
    /// Makes the ring at `at`, which is aligned to 64 bytes and has room for Layout::bytes(depth).
    RingWriter(std::byte* at, std::size_t depth) noexcept
        : head_{new (at) typename Layout::Head}, depth_{depth} {
        std::byte* const slots = at + sizeof(typename Layout::Head);
        for (std::size_t i = 0; i < depth; ++i) {
            new (slots + i * sizeof(typename Layout::Slot)) typename Layout::Slot;
        }
        slots_ = std::launder(reinterpret_cast<typename Layout::Slot*>(slots));
    }

    /// rt. One thread only.
    void push(const T& value) noexcept {
        const std::uint64_t number = head_->count.load(std::memory_order_relaxed);
        slots_[number % depth_].write({number, value});
        head_->count.store(number + 1, std::memory_order_release);
    }

private:
    typename Layout::Head* head_;
    typename Layout::Slot* slots_{nullptr};
    std::size_t depth_;
};

/// A reading end of a ring; any number of them, in any process, each with a place of its own.
template <typename T>
class RingReader {
    using Layout = RingLayout<T>;

public:
    /// Where to begin: with all that is kept, with the last one, or with what is still to come.
    enum class From : std::uint8_t { Oldest, Newest, Next };

    RingReader(const std::byte* at, std::size_t depth, From from) noexcept
        : head_{reinterpret_cast<const typename Layout::Head*>(at)},
          slots_{
              reinterpret_cast<const typename Layout::Slot*>(at + sizeof(typename Layout::Head))},
          depth_{depth} {
        const std::uint64_t count = head_->count.load(std::memory_order_acquire);
        const bool overtaken = count > depth_;
        next_ = overtaken ? count - depth_ : 0;
        if (from == From::Newest && count > 0) next_ = count - 1;
        if (from == From::Next) next_ = count;
    }

    /// rt. \return false when there is none
    [[nodiscard]] bool next(T& value) noexcept {
        constexpr int MostTries = 8;  // a reader that is overtaken again and again comes back later
        for (int i = 0; i < MostTries; ++i) {
            const std::uint64_t count = head_->count.load(std::memory_order_acquire);
            if (next_ >= count) return false;
            if (count - next_ <= depth_ && read(value)) return true;
            const std::uint64_t resume = count - (count < depth_ ? count : depth_) / 2;
            if (resume <= next_) continue;
            missed_ += resume - next_;
            next_ = resume;
        }
        return false;
    }

    /// How many were overwritten before they were read.
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }

private:
    bool read(T& value) noexcept {
        typename Layout::Entry entry;
        if (!slots_[next_ % depth_].tryRead(entry) || entry.number != next_) return false;
        value = entry.value;
        ++next_;
        return true;
    }

    const typename Layout::Head* head_;
    const typename Layout::Slot* slots_;
    std::size_t depth_;
    std::uint64_t next_{0};
    std::uint64_t missed_{0};
};

}  // namespace takt::bridge
