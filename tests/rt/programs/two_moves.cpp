/// Homes, goes to 40 mm and back to 12.5 mm, switches off.
#include <takt/takt.hpp>

namespace {

class TwoMoves : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        axis_ = machine.axis("X");
        power_.Enable = true;
        there_.Position = 40.0;
        back_.Position = 12.5;
        there_.Velocity = back_.Velocity = 200.0;
    }
    takt::ProgramState cycle(takt::Machine& machine) override {
        power_(axis_);
        home_.Execute = power_.Status;
        home_(axis_);
        there_.Execute = home_.Done || there_.Execute;
        there_(axis_);
        back_.Execute = there_.Done || back_.Execute;
        back_(axis_);
        if (power_.Error || home_.Error || there_.Error || back_.Error) {
            machine.fail("a block reports an error");
            return takt::ProgramState::Failed;
        }
        return back_.Done ? takt::ProgramState::Finished : takt::ProgramState::Running;
    }

private:
    takt::AxisRef axis_;
    takt::MC_Power power_;
    takt::MC_Home home_;
    takt::MC_MoveAbsolute there_;
    takt::MC_MoveAbsolute back_;
};

}  // namespace

TAKT_PROGRAM(TwoMoves)
