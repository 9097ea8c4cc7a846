#pragma once

#include <takt/planner/profile.hpp>

#include "problem.hpp"

namespace takt::planner {

/// Turns pieces into a profile. Positions are summed from zero and moved to the start in the end.
class ProfileBuilder {
public:
    /// Third order: the values of the pieces are jerks.
    static void withJerks(const State& from, const detail::Pieces& pieces, Profile& out) noexcept;
    /// The same without the rounding of the sums, for pieces of very different lengths.
    static void withJerksExactly(const State& from, const detail::Pieces& pieces,
                                 Profile& out) noexcept;
    /// Second order: the values are accelerations.
    static void withAccelerations(const State& from, const detail::Pieces& pieces,
                                  Profile& out) noexcept;
    /// First order: the values are velocities.
    static void withVelocities(const State& from, const detail::Pieces& pieces,
                               Profile& out) noexcept;
    /// One after the other. \return false if they have too many pieces
    static bool joined(const Profile& first, const Profile& second, Profile& out) noexcept;
    /// The share of an axis in a motion along a straight line.
    static void scaled(const Profile& line, double share, const State& from, const State& end,
                       Profile& out) noexcept;
    /// A motion as seen from a carrier that keeps its velocity, seen from outside.
    static void carried(const Profile& relative, const State& carrier, Profile& out) noexcept;
    /// The duration that was aimed at, where the sum of the pieces is some ulps off.
    static void setDuration(double duration, Profile& profile) noexcept;
    /// Sets the state that is reached, and sums up the pieces after the longest one backwards from
    /// it: near its end the profile is as exact as the target, so that it can be planned again from
    /// there. What rounding has left is in the middle.
    static void closeOn(const State& end, Profile& profile) noexcept;
};

}  // namespace takt::planner
