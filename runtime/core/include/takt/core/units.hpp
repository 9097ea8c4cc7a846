#pragma once

#include <compare>

namespace takt::core {

/// A quantity in powers of the axis' user length unit (mm or degree, fixed per axis) and of
/// seconds. The same size and cost as a bare double; mixing kinds does not compile.
template <int LengthExp, int TimeExp>
class Quantity {
public:
    constexpr Quantity() noexcept = default;
    constexpr explicit Quantity(double value) noexcept : value_{value} {}

    /// The bare number, for mathematics, wire formats and logs.
    [[nodiscard]] constexpr double count() const noexcept { return value_; }

    friend constexpr auto operator<=>(Quantity, Quantity) noexcept = default;
    friend constexpr Quantity operator+(Quantity a, Quantity b) noexcept {
        return Quantity{a.value_ + b.value_};
    }
    friend constexpr Quantity operator-(Quantity a, Quantity b) noexcept {
        return Quantity{a.value_ - b.value_};
    }
    friend constexpr Quantity operator-(Quantity a) noexcept { return Quantity{-a.value_}; }
    friend constexpr Quantity operator*(Quantity a, double factor) noexcept {
        return Quantity{a.value_ * factor};
    }
    friend constexpr Quantity operator*(double factor, Quantity a) noexcept { return a * factor; }
    friend constexpr Quantity operator/(Quantity a, double divisor) noexcept {
        return Quantity{a.value_ / divisor};
    }
    constexpr Quantity& operator+=(Quantity other) noexcept {
        value_ += other.value_;
        return *this;
    }
    constexpr Quantity& operator-=(Quantity other) noexcept {
        value_ -= other.value_;
        return *this;
    }

private:
    double value_{0.0};
};

template <int L1, int T1, int L2, int T2>
[[nodiscard]] constexpr Quantity<L1 + L2, T1 + T2> operator*(Quantity<L1, T1> a,
                                                             Quantity<L2, T2> b) noexcept {
    return Quantity<L1 + L2, T1 + T2>{a.count() * b.count()};
}

template <int L1, int T1, int L2, int T2>
[[nodiscard]] constexpr Quantity<L1 - L2, T1 - T2> operator/(Quantity<L1, T1> a,
                                                             Quantity<L2, T2> b) noexcept {
    return Quantity<L1 - L2, T1 - T2>{a.count() / b.count()};
}

using Seconds = Quantity<0, 1>;
using Distance = Quantity<1, 0>;
using Velocity = Quantity<1, -1>;
using Acceleration = Quantity<1, -2>;
using Jerk = Quantity<1, -3>;

/// A point on an axis in user units. Two points subtract to a Distance; they do not add.
class Position {
public:
    constexpr Position() noexcept = default;
    constexpr explicit Position(double value) noexcept : value_{value} {}

    [[nodiscard]] constexpr double count() const noexcept { return value_; }

    friend constexpr auto operator<=>(Position, Position) noexcept = default;
    friend constexpr Distance operator-(Position a, Position b) noexcept {
        return Distance{a.value_ - b.value_};
    }
    friend constexpr Position operator+(Position a, Distance d) noexcept {
        return Position{a.value_ + d.count()};
    }
    friend constexpr Position operator-(Position a, Distance d) noexcept {
        return Position{a.value_ - d.count()};
    }

private:
    double value_{0.0};
};

}  // namespace takt::core
