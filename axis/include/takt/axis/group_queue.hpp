#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <takt/axis/group_command.hpp>

namespace takt::axis {

/// The motions of a group in their order: the one in control and those that wait. A ring, since
/// commands are large and many of them may end in one cycle.
class GroupQueue {
public:
    static constexpr std::size_t Capacity = 34;

    struct Entry {
        GroupCommand command{};
        std::uint32_t serial{0};
        bool planned{false};  ///< it is in the path that runs, or in the one asked for
    };

    /// rt. \return false, and nothing changes, when full
    bool push(const GroupCommand& command, std::uint32_t serial) noexcept {
        if (count_ == Capacity) return false;
        entries_[(first_ + count_) % Capacity] = {command, serial, false};
        ++count_;
        return true;
    }
    /// rt. \pre !empty()
    void pop() noexcept {
        assert(count_ > 0);
        first_ = (first_ + 1) % Capacity;
        --count_;
    }
    /// rt. \pre !empty()
    void dropLast() noexcept {
        assert(count_ > 0);
        --count_;
    }

    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
    [[nodiscard]] Entry& operator[](std::size_t i) noexcept {
        assert(i < count_);
        return entries_[(first_ + i) % Capacity];
    }
    [[nodiscard]] const Entry& operator[](std::size_t i) const noexcept {
        assert(i < count_);
        return entries_[(first_ + i) % Capacity];
    }
    [[nodiscard]] Entry& front() noexcept { return (*this)[0]; }
    [[nodiscard]] const Entry& front() const noexcept { return (*this)[0]; }

private:
    std::array<Entry, Capacity> entries_{};
    std::size_t first_{0};
    std::size_t count_{0};
};

}  // namespace takt::axis
