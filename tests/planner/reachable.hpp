#pragma once

#include "problems.hpp"

namespace takt::planner::test {

/// Whether a target can be reached in exactly `duration`, decided without any of the planner's
/// mathematics: for a given duration the reachable end positions are an interval, and both of its
/// ends are found by bisection over profiles written down from their definition, in long double.
/// \param slack relative; positions that far outside the interval still count
bool reachable(const Case& c, long double duration, long double slack);

/// The same for the velocity and acceleration of the target only.
bool velocityReachable(const Case& c, long double duration, long double slack);

}  // namespace takt::planner::test
