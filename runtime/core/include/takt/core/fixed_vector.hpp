#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace takt::core {

/// rt. A vector whose capacity is part of its type; it never allocates.
template <typename T, std::size_t Capacity>
class FixedVector {
public:
    /// \return false, and nothing changes, when full
    constexpr bool push(const T& value) noexcept {
        if (size_ == Capacity) return false;
        items_[size_++] = value;
        return true;
    }
    /// Removes the first item; the order of the others stays. \pre !empty()
    constexpr void popFront() noexcept {
        assert(size_ > 0);
        for (std::size_t i = 1; i < size_; ++i) items_[i - 1] = items_[i];
        --size_;
    }
    constexpr void clear() noexcept { size_ = 0; }
    /// Keeps the first `size` items. \pre size <= size()
    constexpr void truncate(std::size_t size) noexcept {
        assert(size <= size_);
        size_ = size;
    }

    [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
    [[nodiscard]] constexpr bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] constexpr bool full() const noexcept { return size_ == Capacity; }
    [[nodiscard]] constexpr T& operator[](std::size_t i) noexcept {
        assert(i < size_);
        return items_[i];
    }
    [[nodiscard]] constexpr const T& operator[](std::size_t i) const noexcept {
        assert(i < size_);
        return items_[i];
    }
    [[nodiscard]] constexpr T& front() noexcept { return (*this)[0]; }
    [[nodiscard]] constexpr const T& front() const noexcept { return (*this)[0]; }
    [[nodiscard]] constexpr T& back() noexcept { return (*this)[size_ - 1]; }
    [[nodiscard]] constexpr const T& back() const noexcept { return (*this)[size_ - 1]; }
    [[nodiscard]] constexpr T* begin() noexcept { return items_.data(); }
    [[nodiscard]] constexpr T* end() noexcept { return items_.data() + size_; }
    [[nodiscard]] constexpr const T* begin() const noexcept { return items_.data(); }
    [[nodiscard]] constexpr const T* end() const noexcept { return items_.data() + size_; }

private:
    std::array<T, Capacity> items_{};
    std::size_t size_{0};
};

}  // namespace takt::core
