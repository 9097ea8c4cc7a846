/// Asks for the machine stop while X moves, resets it, and comes back with a new edge of Enable.
/// Fails, with a reason, when the machine does not keep its rules.
#include <takt/takt.hpp>

namespace {

class ControlProbe : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        x_ = machine.axis("X");
        power_.Enable = true;
        move_.Distance = 200.0;
        move_.Velocity = 300.0;
    }

    takt::ProgramState cycle(takt::Machine& machine) override {
        power_(x_);
        move_.Execute = power_.Status && step_ == 0;
        move_(x_);
        switch (step_) {
            case 0:
                if (x_.port().view().setVelocity.count() < 299.99) break;
                machine.stop("guard door open");
                ++step_;
                break;
            case 1:
                if (power_.Status || ++waited_ < 50) break;
                if (!machine.stopped()) return failed(machine, "the stop is not shown");
                if (power_.ErrorID != takt::axis::ErrorId::MachineStopped)
                    return failed(machine, "MC_Power is silent");
                machine.resetStop();
                next();
                break;
            case 2:
                if (power_.Status) return failed(machine, "power came back without an edge");
                if (++waited_ < 50) break;
                if (machine.stopped()) return failed(machine, "the reset had no effect");
                power_.Enable = false;
                next();
                break;
            case 3:
                power_.Enable = true;
                if (power_.Status) return takt::ProgramState::Finished;
                break;
            default:
                break;
        }
        return takt::ProgramState::Running;
    }
    void describe(takt::Inspector& inspector) override { inspector.watch("step", step_); }

private:
    static takt::ProgramState failed(takt::Machine& machine, const char* why) {
        machine.fail(why);
        return takt::ProgramState::Failed;
    }
    void next() {
        ++step_;
        waited_ = 0;
    }

    takt::AxisRef x_;
    takt::MC_Power power_;
    takt::MC_MoveRelative move_;
    int step_{0};
    int waited_{0};
};

}  // namespace

TAKT_PROGRAM(ControlProbe)
