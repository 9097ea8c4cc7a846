/// Four axes of a line whose network comes from another tool: power on, home on the spot, go
/// through three stations together, power off.

#include <array>
#include <cstddef>
#include <takt/takt.hpp>

namespace {

using takt::AxisRef;
using takt::ProgramState;

constexpr std::size_t AxisCount = 4;
constexpr std::array<const char*, AxisCount> AxisNames{"X", "Y", "Z", "A"};
constexpr std::array<double, AxisCount> Velocities{600.0, 500.0, 200.0, 900.0};

/// Where the axes stand together, in mm and deg.
using Station = std::array<double, AxisCount>;
constexpr std::array<Station, 3> Stations{Station{300.0, 200.0, 80.0, 90.0},
                                          Station{550.0, 350.0, 20.0, 270.0}, Station{}};

class Line : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        for (std::size_t i = 0; i < AxisCount; ++i) {
            axes_[i] = machine.axis(AxisNames[i]);
            power_[i].Enable = true;
        }
    }

    ProgramState cycle(takt::Machine& machine) override {
        std::size_t powered = 0;
        for (std::size_t i = 0; i < AxisCount; ++i) {
            power_[i](axes_[i]);
            if (power_[i].Error) return fail(machine, "an axis lost its power");
            if (power_[i].Status) ++powered;
        }
        switch (step_) {
            case Step::PowerOn:
                if (powered == AxisCount) step_ = Step::Home;
                return ProgramState::Running;
            case Step::Home:
                return home(machine);
            case Step::Travel:
                return travel(machine);
            case Step::PowerOff:
                for (auto& power : power_) power.Enable = false;
                return powered == 0 ? ProgramState::Finished : ProgramState::Running;
        }
        return ProgramState::Failed;
    }

    void describe(takt::Inspector& inspector) override {
        inspector.watch("step", step_);
        inspector.watch("station", station_);
    }

private:
    enum class Step : int { PowerOn, Home, Travel, PowerOff };

    ProgramState home(takt::Machine& machine) {
        bool done = true;
        for (std::size_t i = 0; i < AxisCount; ++i) {
            home_[i].Execute = true;
            home_[i](axes_[i]);
            if (home_[i].Error || home_[i].CommandAborted) return fail(machine, "homing failed");
            done = done && home_[i].Done;
        }
        if (done) step_ = Step::Travel;
        return ProgramState::Running;
    }

    ProgramState travel(takt::Machine& machine) {
        bool done = true;
        for (std::size_t i = 0; i < AxisCount; ++i) {
            move_[i].Position = Stations[station_][i];
            move_[i].Velocity = Velocities[i];
            move_[i].Execute = true;
            move_[i](axes_[i]);
            if (move_[i].Error || move_[i].CommandAborted) return fail(machine, "a move failed");
            done = done && move_[i].Done;
        }
        if (!done) return ProgramState::Running;
        // The falling edge makes the blocks ready for the next station.
        for (std::size_t i = 0; i < AxisCount; ++i) {
            move_[i].Execute = false;
            move_[i](axes_[i]);
        }
        if (++station_ == Stations.size()) step_ = Step::PowerOff;
        return ProgramState::Running;
    }

    static ProgramState fail(takt::Machine& machine, const char* reason) {
        machine.fail(reason);
        return ProgramState::Failed;
    }

    std::array<AxisRef, AxisCount> axes_;
    std::array<takt::MC_Power, AxisCount> power_;
    std::array<takt::MC_Home, AxisCount> home_;
    std::array<takt::MC_MoveAbsolute, AxisCount> move_;
    Step step_{Step::PowerOn};
    std::size_t station_{0};
};

}  // namespace

TAKT_PROGRAM(Line)
