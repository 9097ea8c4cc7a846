#pragma once

#include <cstdint>

namespace takt::core {

/// rt. splitmix64: random numbers from a seed, small, and the same on every machine.
class Random {
public:
    constexpr explicit Random(std::uint64_t seed) noexcept : state_{seed} {}

    constexpr std::uint64_t next() noexcept {
        state_ += 0x9E3779B97F4A7C15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
        return z ^ (z >> 31);
    }
    /// 0 … largest, the latter included
    constexpr std::uint64_t upTo(std::uint64_t largest) noexcept {
        return largest == ~std::uint64_t{0} ? next() : next() % (largest + 1);
    }
    /// From 0, included, to 1, excluded.
    constexpr double uniform() noexcept {
        constexpr double Step = 0x1p-53;
        return static_cast<double>(next() >> 11) * Step;
    }
    constexpr double uniform(double low, double high) noexcept {
        return low + (high - low) * uniform();
    }

private:
    std::uint64_t state_;
};

}  // namespace takt::core
