#include "quantity.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

namespace takt::config {

namespace {

struct Unit {
    std::string_view name;
    std::int64_t numerator;    ///< base units per unit …
    std::int64_t denominator;  ///< … as a fraction
};

// The first unit of each list is the one shown in examples.
constexpr std::array Times{Unit{"ms", 1'000'000, 1}, Unit{"us", 1000, 1}, Unit{"ns", 1, 1},
                           Unit{"s", 1'000'000'000, 1}, Unit{"min", 60'000'000'000, 1}};
constexpr std::array Frequencies{Unit{"ppm", 1, 1}};
constexpr std::array Rates{Unit{"Hz", 1, 1}, Unit{"kHz", 1000, 1}};
constexpr std::array Shares{Unit{"%", 1, 100}};
constexpr std::array Torques{Unit{"Nm", 1, 1}, Unit{"mNm", 1, 1000}};
constexpr std::array Inertias{Unit{"kg cm^2", 1, 10'000}, Unit{"kg m^2", 1, 1},
                              Unit{"g cm^2", 1, 10'000'000}};
constexpr std::array MotorSpeeds{Unit{"rpm", 1, 60}, Unit{"turns/s", 1, 1}};
constexpr std::array MotorTurns{Unit{"turns", 1, 1}};
constexpr std::array Lengths{Unit{"mm", 1, 1}, Unit{"um", 1, 1000}, Unit{"cm", 10, 1},
                             Unit{"m", 1000, 1}};
constexpr std::array LinearVelocities{Unit{"mm/s", 1, 1}, Unit{"m/s", 1000, 1},
                                      Unit{"mm/min", 1, 60}, Unit{"m/min", 1000, 60}};
constexpr std::array LinearAccelerations{Unit{"mm/s^2", 1, 1}, Unit{"m/s^2", 1000, 1}};
constexpr std::array LinearJerks{Unit{"mm/s^3", 1, 1}, Unit{"m/s^3", 1000, 1}};
constexpr std::array Angles{Unit{"deg", 1, 1}};
constexpr std::array AngularVelocities{Unit{"deg/s", 1, 1}, Unit{"deg/min", 1, 60},
                                       Unit{"rpm", 6, 1}};
constexpr std::array AngularAccelerations{Unit{"deg/s^2", 1, 1}};
constexpr std::array AngularJerks{Unit{"deg/s^3", 1, 1}};

std::span<const Unit> unitList(Dimension dimension) noexcept {
    switch (dimension) {
        case Dimension::Time:
            return Times;
        case Dimension::Frequency:
            return Frequencies;
        case Dimension::Rate:
            return Rates;
        case Dimension::Share:
            return Shares;
        case Dimension::Torque:
            return Torques;
        case Dimension::Inertia:
            return Inertias;
        case Dimension::MotorSpeed:
            return MotorSpeeds;
        case Dimension::MotorTurns:
            return MotorTurns;
        case Dimension::Length:
            return Lengths;
        case Dimension::LinearVelocity:
            return LinearVelocities;
        case Dimension::LinearAcceleration:
            return LinearAccelerations;
        case Dimension::LinearJerk:
            return LinearJerks;
        case Dimension::Angle:
            return Angles;
        case Dimension::AngularVelocity:
            return AngularVelocities;
        case Dimension::AngularAcceleration:
            return AngularAccelerations;
        case Dimension::AngularJerk:
            return AngularJerks;
    }
    return {};
}

void replaceAll(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
        text.replace(at, from.size(), to);
        at += to.size();
    }
}

/// One spelling for "mm/s²", "µs" (micro sign or Greek mu) and "kg·cm²".
std::string plainUnit(std::string_view unit) {
    std::string text{trim(unit)};
    replaceAll(text, "\u00B2", "^2");
    replaceAll(text, "\u00B3", "^3");
    replaceAll(text, "\u00B5", "u");
    replaceAll(text, "\u03BC", "u");
    replaceAll(text, "\u00B0", "deg");
    replaceAll(text, "\u00B7", " ");
    replaceAll(text, "*", " ");
    return text;
}

const Unit* findUnit(std::span<const Unit> units, std::string_view name) noexcept {
    for (const Unit& unit : units) {
        if (unit.name == name) return &unit;
    }
    return nullptr;
}

}  // namespace

std::string unitsOf(Dimension dimension) {
    std::string text;
    for (const Unit& unit : unitList(dimension)) {
        if (!text.empty()) text += ", ";
        text += unit.name;
    }
    return text;
}

std::string exampleOf(Dimension dimension) {
    return fmt::format("100 {}", unitList(dimension).front().name);
}

std::optional<Quantity> parseQuantity(std::string_view text, Dimension dimension,
                                      std::string& problem) {
    const std::string_view whole = trim(text);
    const std::size_t length = numberLength(whole);
    const std::string unitText = plainUnit(whole.substr(length));
    NumberFault fault{};
    const auto number = parseDecimal(whole.substr(0, length), fault);
    if (!number) {
        problem = fault == NumberFault::OutOfRange ? "the number is too large or too small"
                                                   : "this is not a number with a unit";
        return std::nullopt;
    }
    const Unit* const unit = findUnit(unitList(dimension), unitText);
    if (unit == nullptr) {
        problem = unitText.empty() ? "the unit is missing"
                                   : fmt::format("the unit '{}' is not known here", unitText);
        return std::nullopt;
    }
    Quantity quantity;
    if (number->exact)
        quantity.exact = multiply(*number->exact, {unit->numerator, unit->denominator});
    quantity.value = quantity.exact ? quantity.exact->value()
                                    : number->value * static_cast<double>(unit->numerator) /
                                          static_cast<double>(unit->denominator);
    if (!std::isfinite(quantity.value)) {
        problem = "the number is too large";
        return std::nullopt;
    }
    return quantity;
}

}  // namespace takt::config
