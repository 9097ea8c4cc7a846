#include "workloads.hpp"

#include <cstdint>
#include <span>

namespace takt::planner::bench {

namespace {

/// splitmix64: the same numbers everywhere.
class Numbers {
public:
    double between(double low, double high) noexcept {
        std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
        return low + (high - low) * static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1.0p-53;
    }

private:
    std::uint64_t state_{1};
};

State within(Numbers& numbers, const Limits& limits) noexcept {
    const core::Position position{numbers.between(-5, 5)};
    const core::Velocity velocity = limits.maxVelocity * numbers.between(-0.5, 0.5);
    // Half the velocity is left for what the acceleration does on its way back to zero.
    const double swing = 0.5 * limits.maxVelocity.count() * limits.jerk.count();
    const double most = swing < limits.maxAcceleration.count() ? swing / (1 + swing)
                                                               : limits.maxAcceleration.count() / 2;
    const double a = most * most <= 2 * swing ? most : swing / (1 + swing);
    return {position, velocity, core::Acceleration{numbers.between(-0.5, 0.5) * a}};
}

}  // namespace

Workload::Workload(std::size_t axes, std::size_t count) : axes_{axes} {
    Numbers numbers;
    for (std::size_t i = 0; i < axes * count; ++i) {
        const core::Velocity v{numbers.between(0.1, 12)};
        const core::Acceleration a{numbers.between(0.1, 12)};
        const Limits limits{v, -v, a, -a, core::Jerk{numbers.between(0.1, 12)}};
        AxisRequest request;
        request.limits = limits;
        do {
            request.from = within(numbers, limits);
            request.target = {TargetKind::State, within(numbers, limits)};
        } while (findFault(request.from, request.target, limits).has_value());
        requests_.push_back(request);
    }
}

double Workload::plan(std::size_t i, Trajectory& trajectory) const {
    const std::span<const AxisRequest> all{requests_};
    const auto result = trajectory.plan(all.subspan(i * axes_, axes_), {});
    return result.ok() ? result.value().count() : -1.0;
}

}  // namespace takt::planner::bench
