#pragma once

#include <takt/planner/trajectory.hpp>

#include "duration.hpp"

namespace takt::planner::detail {

/// What rounding may have done to a distance: a sampled state is as exact as the motion it is taken
/// from, not as itself, so some ulps of the positions and of the length that the axis needs to go
/// through its velocities.
[[nodiscard]] double positionGrain(const State& from, const State& to,
                                   const Limits& limits) noexcept;

/// One request on its way to a profile: brought back inside its limits, with its fastest answer.
/// Any later duration can be asked for afterwards.
class AxisPlan {
public:
    /// \pre findFault() finds nothing
    void begin(const State& from, const Target& target, const Limits& limits,
               const Resolution& resolution) noexcept;

    /// The least possible duration. Not a number if there is no answer.
    [[nodiscard]] double duration() const noexcept { return duration_; }
    /// The least possible duration >= notBefore.
    [[nodiscard]] double firstPossible(double notBefore) const noexcept;
    /// Durations, sorted and none below duration(), between which everything is possible or nothing
    /// is.
    void marks(Marks& out) const noexcept;
    /// The fastest profile.
    void writeFastest(Profile& out) const noexcept;
    /// A profile of exactly `duration`; false, and nothing written, if that is not possible.
    [[nodiscard]] bool writeLasting(double duration, Profile& out) const noexcept;

    [[nodiscard]] const State& from() const noexcept { return from_; }
    [[nodiscard]] const Target& target() const noexcept { return target_; }

private:
    enum class Order : std::uint8_t { First, Second, Third };

    /// As good as at the target: it can be there early.
    [[nodiscard]] bool canWait(double duration) const noexcept;
    void beginFirstOrder() noexcept;
    void beginSecondOrder() noexcept;
    void beginThirdOrder() noexcept;
    void endBraking() noexcept;
    [[nodiscard]] Pieces braking() const noexcept;
    [[nodiscard]] bool lastingPieces(double duration, Pieces& out) const noexcept;
    void write(Pieces& pieces, Profile& out) const noexcept;
    void writeFirstOrder(double duration, Profile& out) const noexcept;

    State from_{};
    Target target_{};
    Order order_{Order::Third};
    Problem whole_{};
    Problem inner_{};  ///< after the braking
    /// The braking, and behind it the fastest profile where that was found with it.
    Pieces pieces_;
    std::size_t brakingSize_{0};
    double brakingTime_{0.0};
    Possible fastest_{};
    double duration_{0.0};
};

}  // namespace takt::planner::detail
