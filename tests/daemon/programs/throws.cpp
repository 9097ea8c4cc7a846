/// Sets an axis moving, then throws.
#include <stdexcept>
#include <takt/takt.hpp>

namespace {

class Throws : public takt::Program {
public:
    void start(takt::Machine& machine) override { axis_ = machine.axis("X"); }
    takt::ProgramState cycle(takt::Machine& machine) override {
        power_.Enable = true;
        power_(axis_);
        move_.Velocity = 100.0;
        move_.Execute = power_.Status;
        move_(axis_);
        if (move_.InVelocity && atSpeed_++ == 100) throw std::runtime_error("the part is missing");
        static_cast<void>(machine);
        return takt::ProgramState::Running;
    }

private:
    takt::AxisRef axis_;
    takt::MC_Power power_;
    takt::MC_MoveVelocity move_;
    int atSpeed_{0};
};

}  // namespace

TAKT_PROGRAM(Throws)
