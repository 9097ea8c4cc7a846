#pragma once

#include <cmath>
#include <takt/axis/error.hpp>

namespace takt::axis {

/// rt. Fills in the default for 0 and judges an acceleration, deceleration or jerk.
template <typename T>
[[nodiscard]] ErrorId settle(T& value, T byDefault, T limit) noexcept {
    if (!std::isfinite(value.count()) || value < T{0.0}) return ErrorId::InvalidParameter;
    if (value == T{0.0}) value = byDefault;
    return limit < value ? ErrorId::LimitExceeded : ErrorId::None;
}

}  // namespace takt::axis
