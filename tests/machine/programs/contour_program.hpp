#pragma once

#include <array>
#include <cstddef>
#include <takt/takt.hpp>

namespace takt::test {

/// What the programs on the contour machine have in common: power, group, and a step to count.
class ContourProgram : public Program {
public:
    void start(Machine& machine) override {
        constexpr std::array names{"X", "Y", "Z"};
        for (std::size_t i = 0; i < names.size(); ++i) axes_[i] = machine.axis(names[i]);
        group_ = machine.group("G");
        for (auto& power : power_) power.Enable = true;
        enable_.Execute = true;
    }

    ProgramState cycle(Machine& machine) override {
        for (std::size_t i = 0; i < axes_.size(); ++i) power_[i](axes_[i]);
        enable_(group_);
        if (!ready_) {
            ready_ = enable_.Done && power_[0].Status && power_[1].Status && power_[2].Status;
            return ProgramState::Running;
        }
        return move(machine);
    }

    void describe(Inspector& inspector) override {
        inspector.watch("step", step_);
        inspector.watch("error", error_);
    }

protected:
    /// Called in every cycle from the moment all axes have power.
    virtual ProgramState move(Machine& machine) = 0;

    static ProgramState failed(Machine& machine, const char* why) {
        machine.fail(why);
        return ProgramState::Failed;
    }

    std::array<AxisRef, 3> axes_;
    std::array<MC_Power, 3> power_;
    GroupRef group_;
    MC_GroupEnable enable_;
    int step_{0};
    axis::ErrorId error_{};

private:
    bool ready_{false};
};

}  // namespace takt::test
