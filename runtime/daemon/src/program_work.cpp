#include "program_work.hpp"

#include <algorithm>
#include <exception>
#include <takt/core/cycle_guard.hpp>
#include <utility>

namespace takt::daemon {

ProgramWork::ProgramWork(program::ProgramPtr program, std::size_t axisCount,
                         const RouteDesks& routes, std::uint16_t number)
    : program_{std::move(program)} {
    for (std::size_t i = 0; i < axisCount; ++i) {
        areas_.push_back(std::make_unique<axis::AxisPort>(number));
    }
    for (const auto& desk : routes) {
        groupAreas_.push_back(std::make_unique<axis::GroupPort>(number, desk));
    }
}

void ProgramWork::call() noexcept {
    machine_->setCycle(calls_++);
    const core::ProgramCallGuard section;
    try {
        switch (program_->cycle(*machine_)) {
            case program::ProgramState::Running:
                return answer(CallAnswer::Running, {});
            case program::ProgramState::Finished:
                return answer(CallAnswer::Finished, {});
            case program::ProgramState::Failed:
                return answer(CallAnswer::Failed, machine_->failure());
        }
    } catch (const std::exception& error) {
        answer(CallAnswer::Threw, error.what());
    } catch (...) {
        answer(CallAnswer::Threw, "an exception that is not a std::exception");
    }
}

void ProgramWork::answer(CallAnswer answer, std::string_view why) noexcept {
    answer_ = answer;
    failureSize_ = std::min(why.size(), failure_.size());
    std::copy_n(why.begin(), failureSize_, failure_.begin());
}

}  // namespace takt::daemon
