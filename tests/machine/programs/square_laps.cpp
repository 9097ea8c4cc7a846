/// Four laps round a square of 20 mm with corners that may be cut by 0.1 mm, all of them asked for
/// at once.
#include "contour_program.hpp"

namespace {

class SquareLaps : public takt::test::ContourProgram {
public:
    void start(takt::Machine& machine) override {
        ContourProgram::start(machine);
        constexpr std::array<std::array<double, 2>, 4> corners{
            {{20.0, 0.0}, {20.0, 20.0}, {0.0, 20.0}, {0.0, 0.0}}};
        for (std::size_t i = 0; i < sides_.size(); ++i) {
            auto& side = sides_[i];
            side.Position = {corners[i % 4][0], corners[i % 4][1], 0.0};
            side.Velocity = 100.0;
            side.BufferMode = takt::MC_BUFFER_MODE::mcBlendingHigh;
            side.TransitionMode = takt::MC_TRANSITION_MODE::mcTMMaxCornerDeviation;
            side.TransitionParameter = 0.1;
            side.Execute = true;
        }
    }

private:
    takt::ProgramState move(takt::Machine& machine) override {
        step_ = 0;
        for (auto& side : sides_) {
            side(group_);
            if (side.Error || side.CommandAborted) {
                error_ = side.ErrorID;
                return failed(machine, "a side failed");
            }
            if (side.Done) ++step_;
        }
        return sides_.back().Done ? takt::ProgramState::Finished : takt::ProgramState::Running;
    }

    std::array<takt::MC_MoveLinearAbsolute, 16> sides_;
};

}  // namespace

TAKT_PROGRAM(SquareLaps)
