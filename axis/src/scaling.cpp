#include <cmath>
#include <numeric>
#include <stdexcept>
#include <takt/axis/scaling.hpp>

namespace takt::axis {

namespace {

/// 2^51: counts up to here keep a fractional bit in a double, so rounding to the nearest is right.
constexpr double kMaxCounts = 2251799813685248.0;

std::int64_t positive(std::int64_t value, const char* what) {
    if (value <= 0) throw std::invalid_argument{what};
    return value;
}

/// Cancels what two factors of a fraction have in common.
void cancel(std::int64_t& above, std::int64_t& below) noexcept {
    const std::int64_t common = std::gcd(above, below);
    above /= common;
    below /= common;
}

}  // namespace

Scaling::Scaling(const ScalingParams& params) {
    std::int64_t counts = positive(params.countsPerTurn, "countsPerTurn must be positive");
    std::int64_t motor = positive(params.gearMotor, "gearMotor must be positive");
    std::int64_t load = positive(params.gearLoad, "gearLoad must be positive");
    std::int64_t units = positive(params.unitsPerTurnNumerator, "unitsPerTurn must be positive");
    std::int64_t parts = positive(params.unitsPerTurnDenominator, "unitsPerTurn must be positive");
    for (std::int64_t* above : {&counts, &motor, &parts}) {
        for (std::int64_t* below : {&load, &units}) cancel(*above, *below);
    }
    countsNumerator_ = static_cast<double>(counts) * static_cast<double>(motor) *
                       static_cast<double>(parts) * (params.reversed ? -1.0 : 1.0);
    unitsNumerator_ = static_cast<double>(load) * static_cast<double>(units);
    resolution_ = core::Distance{unitsNumerator_ / std::abs(countsNumerator_)};
    maxPosition_ = resolution_ * kMaxCounts;
    if (params.modulo) {
        period_ = params.modulo->count();
        if (!(period_ > 0.0) || !std::isfinite(period_)) {
            throw std::invalid_argument{"the modulo period must be positive"};
        }
    }
}

double Scaling::foldInto(double value, double period) noexcept {
    if (!(period > 0.0)) return value;
    if (value >= 0.0 && value < period) return value;
    auto turns = static_cast<double>(static_cast<std::int64_t>(value / period));
    double folded = value - turns * period;
    if (folded < 0.0) folded += period;
    // Rounding in the division or the sum above may leave the result one period off.
    if (folded >= period) folded -= period;
    return folded < 0.0 ? 0.0 : folded;
}

}  // namespace takt::axis
