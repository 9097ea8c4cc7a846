/// Gives up by itself, with a reason.
#include <takt/takt.hpp>

namespace {

class Fails : public takt::Program {
public:
    takt::ProgramState cycle(takt::Machine& machine) override {
        if (machine.cycle() < 20) return takt::ProgramState::Running;
        machine.fail("no part in the gripper");
        return takt::ProgramState::Failed;
    }
    void describe(takt::Inspector& inspector) override { inspector.watch("grip", grip_); }

private:
    int grip_{7};
};

}  // namespace

TAKT_PROGRAM(Fails)
