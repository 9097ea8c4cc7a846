/// An executable of a machine builder's own: the program is linked in, no library is loaded.
#include <takt/cli/command_line.hpp>
#include <takt/takt.hpp>

namespace {

/// Moves one axis 5 mm and is done.
class Nudge : public takt::Program {
public:
    void start(takt::Machine& machine) override { axis_ = machine.axis("X"); }
    takt::ProgramState cycle(takt::Machine&) override {
        power_.Enable = !move_.Done;
        power_(axis_);
        move_.Distance = 5.0;
        move_.Velocity = 50.0;
        move_.Execute = power_.Status || move_.Busy || move_.Done;
        move_(axis_);
        if (move_.Error || power_.Error) return takt::ProgramState::Failed;
        return move_.Done && !power_.Status ? takt::ProgramState::Finished
                                            : takt::ProgramState::Running;
    }

private:
    takt::AxisRef axis_;
    takt::MC_Power power_;
    takt::MC_MoveRelative move_;
};

}  // namespace

int main(int argc, char** argv) {
    std::vector<takt::daemon::LinkedProgram> programs;
    programs.push_back(takt::cli::linked<Nudge>("pick"));
    return takt::cli::commandLine(argc, argv, std::move(programs));
}
