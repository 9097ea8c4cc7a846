/// Sets an axis moving and then never comes back.
#include <atomic>
#include <takt/takt.hpp>

namespace {

std::atomic<bool> forever{true};  // the compiler may not know that the loop has no end

class Hangs : public takt::Program {
public:
    void start(takt::Machine& machine) override { axis_ = machine.axis("X"); }
    takt::ProgramState cycle(takt::Machine& /*machine*/) override {
        power_.Enable = true;
        power_(axis_);
        move_.Velocity = 100.0;
        move_.Execute = power_.Status;
        move_(axis_);
        if (move_.InVelocity && atSpeed_++ == 25) {
            while (forever.load(std::memory_order_relaxed)) {
            }
        }
        return takt::ProgramState::Running;
    }

private:
    takt::AxisRef axis_;
    takt::MC_Power power_;
    takt::MC_MoveVelocity move_;
    int atSpeed_{0};
};

}  // namespace

TAKT_PROGRAM(Hangs)
