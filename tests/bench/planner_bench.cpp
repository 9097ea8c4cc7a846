#include <benchmark/benchmark.h>

#include <array>

#include "workloads.hpp"

namespace takt::planner::bench {
namespace {

void solve(benchmark::State& state) {
    const Workload workload{static_cast<std::size_t>(state.range(0)), 1000};
    Trajectory trajectory{workload.axes()};
    std::size_t i = 0;
    while (state.KeepRunning()) {
        benchmark::DoNotOptimize(workload.plan(i, trajectory));
        i = (i + 1) % workload.size();
    }
}
BENCHMARK(solve)->Arg(1)->Arg(3)->Arg(6)->Arg(7)->Arg(16);

void sampleAll(benchmark::State& state) {
    const Workload workload{static_cast<std::size_t>(state.range(0)), 1};
    Trajectory trajectory{workload.axes()};
    const double duration = workload.plan(0, trajectory);
    std::array<State, Trajectory::maxAxes> states{};
    double part = 0.0;
    while (state.KeepRunning()) {
        part = part < 1.0 ? part + 0.0137 : 0.0;
        trajectory.sample(core::Seconds{part * duration}, states);
        benchmark::DoNotOptimize(states);
    }
}
BENCHMARK(sampleAll)->Arg(1)->Arg(3)->Arg(6);

}  // namespace
}  // namespace takt::planner::bench
