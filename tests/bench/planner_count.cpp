#include <array>
#include <cstdio>
#include <cstring>

#include "workloads.hpp"

using takt::planner::State;
using takt::planner::Trajectory;
using takt::planner::bench::Workload;

// What callgrind counts; C names, so that it finds them.
extern "C" {

__attribute__((noinline)) double countedSolve(const Workload& workload, Trajectory& trajectory) {
    double sum = 0.0;
    for (std::size_t i = 0; i < workload.size(); ++i) sum += workload.plan(i, trajectory);
    return sum;
}

__attribute__((noinline)) double countedSample(const Trajectory& trajectory, int times) {
    std::array<State, Trajectory::maxAxes> states{};
    double sum = 0.0;
    for (int i = 0; i < times; ++i) {
        trajectory.sample(trajectory.duration() * (static_cast<double>(i) / times), states);
        sum += states[0].position.count();
    }
    return sum;
}
}

/// planner_count solve AXES | sample AXES
int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const auto axes = static_cast<std::size_t>(argv[2][0] - '0');
    const Workload workload{axes, 1000};
    Trajectory trajectory{axes};
    workload.plan(0, trajectory);
    const bool solve = std::strcmp(argv[1], "solve") == 0;
    const double sum = solve ? countedSolve(workload, trajectory) : countedSample(trajectory, 1000);
    std::printf("%.17g\n", sum);
    return 0;
}
