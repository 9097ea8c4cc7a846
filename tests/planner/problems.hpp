#pragma once

#include <cstdint>
#include <string>
#include <takt/planner/profile.hpp>

/// Random problems and an independent judge of profiles, in long double.
namespace takt::planner::test {

/// splitmix64: the same numbers everywhere.
class Random {
public:
    explicit Random(std::uint64_t seed) noexcept : state_{seed} {}
    std::uint64_t next() noexcept;
    double uniform() noexcept;
    double uniform(double low, double high) noexcept;
    double logarithmic(double low, double high) noexcept;
    bool chance(double probability) noexcept { return uniform() < probability; }
    int integer(int low, int high) noexcept;

private:
    std::uint64_t state_;
};

struct Case {
    State from;
    Target target;
    Limits limits;
};

State state(double p, double v, double a);
Limits limits(double v, double a, double j);
Limits limits(double vmax, double vmin, double amax, double amin, double j);
Target rest(double p);

/// Limits within one decade, states anywhere within them.
Case ordinary(Random& random);
/// Six decades of limits, short and long moves.
Case wide(Random& random);
/// Targets that are all but reached.
Case near(Random& random);
/// States on the limits: v, a or both at their greatest.
Case saturated(Random& random);
/// States and limits from -2..2: ties everywhere.
Case grid(Random& random);
/// A start far outside the limits.
Case outside(Random& random);

std::string describe(const Case& c);

/// What is wrong with a profile as an answer to `c`, judged by integrating its pieces; empty if
/// nothing is.
std::string judge(const Case& c, const Profile& profile);

}  // namespace takt::planner::test
