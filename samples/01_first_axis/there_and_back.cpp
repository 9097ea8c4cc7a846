/// The first axis: power on, go there, come back at constant speed, halt on the way, go home, power
/// off. Every motion is a PLCopen block that is called once per cycle.

#include <takt/takt.hpp>

namespace {

using takt::ProgramState;

class ThereAndBack : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        x_ = machine.axis("X");
        power_.Enable = true;
        position_.Enable = true;
        there_.Position = 500.0;  // mm, as the machine file says
        there_.Velocity = 400.0;  // mm/s
        back_.Velocity = 100.0;
        back_.Direction = takt::MC_DIRECTION::mcNegativeDirection;
        home_.Position = 0.0;
        home_.Velocity = 200.0;
    }

    ProgramState cycle(takt::Machine& machine) override {
        callBlocks();
        if (power_.Error || there_.Error || back_.Error || halt_.Error || home_.Error) {
            machine.fail("the axis refused a command or lost its power");
            return ProgramState::Failed;
        }
        switch (step_) {
            case Step::PowerOn:
                if (power_.Status) step_ = Step::There;
                break;
            case Step::There:
                there_.Execute = true;
                if (there_.Done) step_ = Step::Back;
                break;
            case Step::Back:
                back_.Execute = true;
                if (position_.Position < 300.0) step_ = Step::Halt;
                break;
            case Step::Halt:
                halt_.Execute = true;
                if (halt_.Done) step_ = Step::Home;
                break;
            case Step::Home:
                home_.Execute = true;
                if (home_.Done) step_ = Step::PowerOff;
                break;
            case Step::PowerOff:
                power_.Enable = false;
                if (!power_.Status) return ProgramState::Finished;
                break;
        }
        return ProgramState::Running;
    }

    void describe(takt::Inspector& inspector) override {
        inspector.watch("step", step_);
        inspector.block("power", power_);
        inspector.block("there", there_);
        inspector.block("back", back_);
    }

private:
    enum class Step : int { PowerOn, There, Back, Halt, Home, PowerOff };

    /// Each block once per cycle: a block works by being called, and its outputs are those of its
    /// last call.
    void callBlocks() {
        power_(x_);
        position_(x_);
        there_(x_);
        back_(x_);
        halt_(x_);
        home_(x_);
    }

    takt::AxisRef x_;
    takt::MC_Power power_;
    takt::MC_ReadActualPosition position_;
    takt::MC_MoveAbsolute there_;
    takt::MC_MoveVelocity back_;
    takt::MC_Halt halt_;
    takt::MC_MoveAbsolute home_;
    Step step_{Step::PowerOn};
};

}  // namespace

TAKT_PROGRAM(ThereAndBack)
