#pragma once

namespace takt::core {

/// The elementary functions that cycle and twin may use: from + - * / and sqrt only, so every
/// processor gives the same bits. The library's own differ between processors.
struct SinCos {
    double sin;
    double cos;
};

/// rt. Within 1 ulp of the greater of the two for |angle| <= 1e5 radians; beyond that the error
/// grows with the angle. NaN for what is not finite.
[[nodiscard]] SinCos sinCos(double angle) noexcept;

/// rt. The angle of the point (x, y), in (-pi, pi]; 0 for the origin.
[[nodiscard]] double angleOf(double x, double y) noexcept;

/// rt. The cube root.
[[nodiscard]] double cubeRoot(double x) noexcept;

inline constexpr double pi = 3.14159265358979323846;

}  // namespace takt::core
