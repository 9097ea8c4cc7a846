#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace takt::record {

/// Counts of a non-negative number (a time in ns, a size) in bins that double in width: bin 0 holds
/// 0, bin n holds 2^(n-1) … 2^n - 1. Fixed size, copied as a whole into a status snapshot.
class Histogram {
public:
    static constexpr std::size_t Bins = 65;

    /// rt. A negative value counts as 0.
    void add(std::int64_t value) noexcept {
        const std::uint64_t v = value < 0 ? 0 : static_cast<std::uint64_t>(value);
        ++bins_[static_cast<std::size_t>(std::bit_width(v))];
        if (count_ == 0 || v < min_) min_ = v;
        if (v > max_) max_ = v;
        sum_ += v;
        ++count_;
    }
    /// rt.
    void clear() noexcept { *this = Histogram{}; }

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    [[nodiscard]] std::uint64_t min() const noexcept { return min_; }
    [[nodiscard]] std::uint64_t max() const noexcept { return max_; }
    /// Rounded down; 0 when empty.
    [[nodiscard]] std::uint64_t mean() const noexcept { return count_ == 0 ? 0 : sum_ / count_; }
    [[nodiscard]] std::uint64_t bin(std::size_t index) const noexcept { return bins_[index]; }

    /// A bound that `permille` thousandths of the values do not exceed: the upper end of their bin,
    /// but never more than the largest value. 0 when empty. \pre permille <= 1000
    [[nodiscard]] std::uint64_t atMost(std::uint32_t permille) const noexcept {
        const std::uint64_t wanted = (count_ * permille + 999) / 1000;
        std::uint64_t seen = 0;
        for (std::size_t i = 0; i < Bins; ++i) {
            seen += bins_[i];
            if (seen >= wanted) {
                const std::uint64_t upper =
                    i >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << i) - 1;
                return upper < max_ ? upper : max_;
            }
        }
        return max_;
    }

private:
    std::array<std::uint64_t, Bins> bins_{};
    std::uint64_t count_{0};
    std::uint64_t sum_{0};
    std::uint64_t min_{0};
    std::uint64_t max_{0};
};

}  // namespace takt::record
