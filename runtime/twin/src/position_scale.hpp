#pragma once

#include <cstdint>

namespace takt::twin {

/// The drive's electronic gear between user counts and the increments of its encoder, in whole
/// numbers.
class PositionScale {
public:
    static constexpr int EncoderBits = 23;
    static constexpr std::int64_t IncrementsPerTurn = std::int64_t{1} << EncoderBits;

    /// `counts` user counts in `turns` turns of the motor; both at least 1.
    PositionScale(std::int64_t counts, bool truncates, std::int64_t turns = 1) noexcept
        : counts_{counts}, increments_{IncrementsPerTurn * turns}, truncates_{truncates} {}

    /// rt. Encoder increments of a motor position in turns.
    [[nodiscard]] static std::int64_t increments(double turns) noexcept {
        const double scaled = turns * static_cast<double>(IncrementsPerTurn);
        return static_cast<std::int64_t>(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);
    }
    [[nodiscard]] static double turns(std::int64_t increments) noexcept {
        return static_cast<double>(increments) / static_cast<double>(IncrementsPerTurn);
    }
    /// rt. User counts shown for a number of increments.
    [[nodiscard]] std::int64_t counts(std::int64_t increments) const noexcept {
        return scale(increments, counts_, increments_);
    }
    /// rt. Increments demanded by a number of user counts.
    [[nodiscard]] std::int64_t fromCounts(std::int64_t counts) const noexcept {
        return scale(counts, increments_, counts_);
    }
    [[nodiscard]] double countsPerTurn() const noexcept {
        return static_cast<double>(counts_) *
               (static_cast<double>(IncrementsPerTurn) / static_cast<double>(increments_));
    }

private:
    /// value · numerator / denominator without overflow; towards zero, or to the nearest.
    [[nodiscard]] std::int64_t scale(std::int64_t value, std::int64_t numerator,
                                     std::int64_t denominator) const noexcept {
        const std::int64_t whole = value / denominator;
        std::int64_t rest = value % denominator * numerator;
        if (!truncates_) rest += rest < 0 ? -(denominator / 2) : denominator / 2;
        return whole * numerator + rest / denominator;
    }

    std::int64_t counts_;      ///< user counts …
    std::int64_t increments_;  ///< … in these increments
    bool truncates_;
};

}  // namespace takt::twin
