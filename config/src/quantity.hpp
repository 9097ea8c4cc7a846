#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "numbers.hpp"

/// Numbers with their unit written out, as machine files want them: "120 mm", "2000 mm/s^2", "20
/// ppm".
namespace takt::config {

/// What a quantity measures. The base unit of each kind is what the parameter structs carry.
enum class Dimension : std::uint8_t {
    Time,                 ///< ns
    Frequency,            ///< ppm: deviation of a clock
    Rate,                 ///< Hz
    Share,                ///< 1: part of a whole, written in %
    Torque,               ///< Nm
    Inertia,              ///< kg m^2
    MotorSpeed,           ///< turns per second
    MotorTurns,           ///< turns
    Length,               ///< mm
    LinearVelocity,       ///< mm/s
    LinearAcceleration,   ///< mm/s^2
    LinearJerk,           ///< mm/s^3
    Angle,                ///< deg
    AngularVelocity,      ///< deg/s
    AngularAcceleration,  ///< deg/s^2
    AngularJerk,          ///< deg/s^3
};

struct Quantity {
    double value{0.0};           ///< in the base unit, rounded once
    std::optional<Ratio> exact;  ///< the same without rounding, where 64-bit numbers hold it
};

/// "mm, um, cm, m": all units that a kind of quantity may be written in.
[[nodiscard]] std::string unitsOf(Dimension dimension);
/// "500 mm/s": how one is written, for messages.
[[nodiscard]] std::string exampleOf(Dimension dimension);

/// \param problem what is wrong, when there is no value
[[nodiscard]] std::optional<Quantity> parseQuantity(std::string_view text, Dimension dimension,
                                                    std::string& problem);

}  // namespace takt::config
