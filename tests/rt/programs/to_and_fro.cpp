/// Moves to and fro for ever.
#include <takt/takt.hpp>

namespace {

class ToAndFro : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        axis_ = machine.axis("X");
        power_.Enable = true;
        move_.Velocity = 100.0;
    }
    takt::ProgramState cycle(takt::Machine& /*machine*/) override {
        power_(axis_);
        if (move_.Done) move_.Execute = false;
        move_.Distance = forth_ ? 40.0 : -40.0;
        move_(axis_);
        if (!move_.Execute && power_.Status) {
            forth_ = !forth_;
            move_.Execute = true;
        }
        return takt::ProgramState::Running;
    }

private:
    takt::AxisRef axis_;
    takt::MC_Power power_;
    takt::MC_MoveRelative move_;
    bool forth_{false};
};

}  // namespace

TAKT_PROGRAM(ToAndFro)
