#pragma once

#include <takt/planner/profile.hpp>

#include "duration.hpp"

namespace takt::planner::detail {

/// One request on its way to a profile: brought back inside its limits, with its fastest answer.
/// Any later duration can be asked for afterwards.
class AxisPlan {
public:
    AxisPlan() noexcept = default;
    /// \pre findFault() finds nothing
    AxisPlan(const State& from, const Target& target, const Limits& limits) noexcept;

    /// The least possible duration. Not a number if there is no answer.
    [[nodiscard]] double duration() const noexcept { return duration_; }
    /// The least possible duration >= notBefore.
    [[nodiscard]] double firstPossible(double notBefore) const noexcept;
    /// The fastest profile.
    void writeFastest(Profile& out) const noexcept;
    /// A profile of exactly `duration`; false, and nothing written, if that is not possible.
    [[nodiscard]] bool writeLasting(double duration, Profile& out) const noexcept;

    [[nodiscard]] const State& from() const noexcept { return from_; }
    [[nodiscard]] const Target& target() const noexcept { return target_; }

private:
    enum class Order : std::uint8_t { First, Second, Third };

    void begin() noexcept;
    [[nodiscard]] double secondVelocity(Pieces& out) const noexcept;
    [[nodiscard]] bool lastingPieces(double duration, Pieces& out) const noexcept;
    void write(Pieces& pieces, Profile& out) const noexcept;
    void writeFirstOrder(double duration, Profile& out) const noexcept;

    State from_{};
    Target target_{};
    Order order_{Order::Third};
    Problem whole_{};
    Problem inner_{};  ///< after the braking
    Pieces braking_;
    double brakingTime_{0.0};
    Possible fastest_{};
    double duration_{0.0};
};

}  // namespace takt::planner::detail
