/// Goes round a circle and stops half-way, as TAKT_TEST_CASE says: halt, stop, member-stop, throw,
/// blocked (an axis meets a hard stop; the group is reset and goes back).
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "contour_program.hpp"

namespace {

class CircleStops : public takt::test::ContourProgram {
public:
    void start(takt::Machine& machine) override {
        ContourProgram::start(machine);
        const char* const value = std::getenv("TAKT_TEST_CASE");
        case_ = value != nullptr ? value : "none";
        setArc(there_, {20.0, 20.0, 0.0}, {0.0, 40.0, 0.0});
        setArc(back_, {-20.0, 20.0, 0.0}, {0.0, 0.0, 0.0});
        back_.BufferMode = takt::MC_BUFFER_MODE::mcBlendingHigh;
        line_.Velocity = 50.0;
    }

private:
    static void setArc(takt::MC_MoveCircularAbsolute& arc, const takt::plcopen::GroupArray& via,
                       const takt::plcopen::GroupArray& end) {
        arc.CircMode = takt::MC_CIRC_MODE::mcBorder;
        arc.AuxPoint = via;
        arc.EndPoint = end;
        arc.Velocity = 90.0;
        arc.Execute = true;
    }

    takt::ProgramState move(takt::Machine& machine) override {
        const bool now = there_.Active && machine.cycle() > 0 && ++underWay_ == Moment;
        if (now) trigger();
        there_(group_);
        back_(group_);
        halt_(group_);
        stop_(group_);
        memberStop_(axes_[1]);
        status_.Enable = true;
        status_(group_);
        if (case_ == "none") return back_.Done ? takt::ProgramState::Finished : state(machine);
        if (case_ == "blocked") return recover(machine);
        if (halt_.Done) return takt::ProgramState::Finished;
        if (stop_.Done) stop_.Execute = false;
        if (memberStop_.Done) memberStop_.Execute = false;
        const bool stopped = underWay_ > Moment && status_.GroupStandby && there_.CommandAborted;
        return stopped ? takt::ProgramState::Finished : takt::ProgramState::Running;
    }

    takt::ProgramState state(takt::Machine& machine) {
        error_ = there_.Error ? there_.ErrorID : back_.ErrorID;
        return there_.Error || back_.Error ? failed(machine, "an arc failed")
                                           : takt::ProgramState::Running;
    }

    void trigger() {
        if (case_ == "halt") halt_.Execute = true;
        if (case_ == "stop") stop_.Execute = true;
        if (case_ == "member-stop") memberStop_.Execute = true;
        if (case_ == "throw") throw std::runtime_error{"half-way round"};
    }

    /// Off, reset, on, and back to where the path began.
    takt::ProgramState recover(takt::Machine& machine) {
        if (step_ == 0 && status_.GroupErrorStop && there_.Error && ++rest_ > 200) {
            error_ = there_.ErrorID;
            for (auto& power : power_) power.Enable = false;
            step_ = 1;
        } else if (step_ == 1 && ++rest_ > 300) {
            reset_.Execute = true;
            if (reset_.Error) return failed(machine, "the reset failed");
            if (reset_.Done && status_.GroupStandby) step_ = 2;
        } else if (step_ == 2) {
            for (auto& power : power_) power.Enable = true;
            line_.Execute = power_[0].Status && power_[1].Status && power_[2].Status;
            if (line_.Error) return failed(machine, "the way back failed");
        }
        reset_(group_);
        line_(group_);
        return line_.Done ? takt::ProgramState::Finished : takt::ProgramState::Running;
    }

    static constexpr int Moment = 350;

    std::string case_;
    takt::MC_MoveCircularAbsolute there_;
    takt::MC_MoveCircularAbsolute back_;
    takt::MC_GroupHalt halt_;
    takt::MC_GroupStop stop_;
    takt::MC_Stop memberStop_;
    takt::MC_GroupReadStatus status_;
    takt::MC_GroupReset reset_;
    takt::MC_MoveLinearAbsolute line_;
    int underWay_{0};
    int rest_{0};
};

}  // namespace

TAKT_PROGRAM(CircleStops)
