#pragma once

#include <cassert>
#include <type_traits>

namespace takt::core {

/// rt. Result of a call in the cyclic path: a value or an error number. Never allocates, never
/// throws.
template <typename T, typename E>
class [[nodiscard]] Result {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_copyable_v<E>);

public:
    constexpr Result(T value) noexcept : value_{value}, ok_{true} {}
    constexpr Result(E error) noexcept : error_{error}, ok_{false} {}

    [[nodiscard]] constexpr bool ok() const noexcept { return ok_; }
    /// \pre ok()
    [[nodiscard]] constexpr const T& value() const noexcept {
        assert(ok_);
        return value_;
    }
    /// \pre !ok()
    [[nodiscard]] constexpr E error() const noexcept {
        assert(!ok_);
        return error_;
    }

private:
    union {
        T value_;
        E error_;
    };
    bool ok_;
};

}  // namespace takt::core
