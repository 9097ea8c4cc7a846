#include <fmt/format.h>

#include <limits>
#include <takt/scheduler/scheduler_params.hpp>

#include "machine_parts.hpp"

namespace takt::config {

namespace {

constexpr std::int64_t HighestPriority =
    99;  // of SCHED_FIFO; interrupts and the kernel keep the rest
constexpr std::int64_t MostProcessors = 1023;
constexpr std::int64_t MostMissed = 100'000;

}  // namespace

void readRealtime(ElementReader reader, scheduler::SchedulerParams& params) {
    using Policy = scheduler::OverrunPolicy;
    scheduler::OverrunParams& overruns = params.overruns;
    params.priority = static_cast<int>(
        reader.integer("priority", {0, HighestPriority}).value_or(params.priority));
    params.cpu = static_cast<int>(reader.integer("cpu", {0, MostProcessors}).value_or(params.cpu));
    overruns.policy =
        reader.choice<Policy>("overruns", {{"react", Policy::React}, {"count", Policy::Count}})
            .value_or(overruns.policy);
    overruns.stopAfter = static_cast<std::uint32_t>(
        reader.integer("stopAfter", {1, MostMissed}).value_or(overruns.stopAfter));
    overruns.driveStopAfter = static_cast<std::uint32_t>(
        reader.integer("driveStopAfter", {1, MostMissed}).value_or(overruns.driveStopAfter));
    const auto rate = reader.quantity("overrunRate", Dimension::Share, Sign::NotNegative);
    overruns.rate = rate ? rate->value : overruns.rate;
    reader.finish();
    if (overruns.driveStopAfter < overruns.stopAfter) {
        reader.error("driveStopAfter", "the drives would stop before the axes stop on their path",
                     fmt::format("{} (stopAfter) or more", overruns.stopAfter));
    }
    if (overruns.rate > 1.0) {
        reader.error("overrunRate", "more than all cycles cannot be missed", "up to 100 %");
    }
}

}  // namespace takt::config
