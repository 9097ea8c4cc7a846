/// Moves X and raises signals in a phase of the motion that the environment names, so that a test
/// hits it to the cycle: TAKT_TEST_PHASE = enable, homing, acceleration, constant, deceleration,
/// standstill or never; TAKT_TEST_SIGNAL = number (2 when absent); TAKT_TEST_COUNT = how many at
/// once (1 when absent).
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <takt/takt.hpp>

namespace {

std::string setting(const char* name, const char* otherwise) {
    const char* const value = std::getenv(name);
    return value != nullptr ? value : otherwise;
}

class Signals : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        x_ = machine.axis("X");
        phase_ = setting("TAKT_TEST_PHASE", "constant");
        signal_ = std::stoi(setting("TAKT_TEST_SIGNAL", "2"));
        count_ = std::stoi(setting("TAKT_TEST_COUNT", "1"));
        power_.Enable = true;
        move_.Distance = 200.0;
        move_.Velocity = 300.0;
        move_.Acceleration = 2000.0;
        move_.Deceleration = 2000.0;
    }

    takt::ProgramState cycle(takt::Machine& machine) override {
        power_(x_);
        home_.Execute = power_.Status && phase_ == "homing";
        home_(x_);
        move_.Execute = power_.Status && phase_ != "homing" && phase_ != "enable";
        move_(x_);
        if (!raised_ && due(machine)) {
            raised_ = true;
            // To the process, whichever thread this is; two of one kind at once would be one.
            for (int i = 0; i < count_; ++i) kill(getpid(), i == 0 ? signal_ : SIGTERM);
        }
        return takt::ProgramState::Running;
    }

private:
    bool due(const takt::Machine& machine) {
        const auto& view = x_.port().view();
        const double v = view.setVelocity.count();
        const bool braking = v < last_;
        last_ = v;
        if (phase_ == "never") return false;
        if (phase_ == "enable") return machine.cycle() == 5;
        if (phase_ == "homing") return home_.Active && ++homing_ == 300;
        if (phase_ == "acceleration") return v > 100.0;
        if (phase_ == "constant") return v > 299.99;
        if (phase_ == "deceleration") return braking && v < 200.0;
        return move_.Done;
    }

    takt::AxisRef x_;
    takt::MC_Power power_;
    takt::MC_Home home_;
    takt::MC_MoveRelative move_;
    std::string phase_;
    int signal_{0};
    int count_{0};
    int homing_{0};
    double last_{0.0};
    bool raised_{false};
};

}  // namespace

TAKT_PROGRAM(Signals)
