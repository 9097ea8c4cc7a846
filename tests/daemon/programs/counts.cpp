/// Moves X up and down for ever, and shows how often it was called and which of its instances it
/// is.
#include <takt/takt.hpp>

namespace {

int instances = 0;

class Counts : public takt::Program {
public:
    Counts() : instance_{++instances} {}
    void start(takt::Machine& machine) override {
        x_ = machine.axis("X");
        power_.Enable = true;
        there_.Position = 600.0;
        back_.Position = 100.0;
        there_.Velocity = back_.Velocity = 50.0;
    }
    takt::ProgramState cycle(takt::Machine&) override {
        ++calls_;
        power_(x_);
        if (there_.Done) returning_ = true;
        if (back_.Done) returning_ = false;
        there_.Execute = power_.Status && !returning_;
        back_.Execute = power_.Status && returning_;
        there_(x_);
        back_(x_);
        return takt::ProgramState::Running;
    }
    void describe(takt::Inspector& inspector) override {
        inspector.watch("calls", calls_);
        inspector.watch("instance", instance_);
    }

private:
    takt::AxisRef x_;
    takt::MC_Power power_;
    takt::MC_MoveAbsolute there_;
    takt::MC_MoveAbsolute back_;
    int calls_{0};
    int instance_;
    bool returning_{false};
};

}  // namespace

TAKT_PROGRAM(Counts)
