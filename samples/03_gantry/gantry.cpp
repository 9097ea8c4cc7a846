/// Pick and place on a three-axis gantry: power on, home, then carry parts from one place to
/// another. Every motion is a PLCopen block that is called once per cycle.

#include <array>
#include <cstddef>
#include <takt/takt.hpp>

namespace {

using takt::AxisRef;
using takt::ProgramState;

/// Axes in the order in which they home: the tool goes up first.
enum Axis : std::size_t { Z, X, Y, AxisCount };

class Gantry : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        axes_[Z] = machine.axis("Z");
        axes_[X] = machine.axis("X");
        axes_[Y] = machine.axis("Y");
        for (auto& power : power_) power.Enable = true;
    }

    ProgramState cycle(takt::Machine& machine) override {
        if (!keepPowered(machine)) return ProgramState::Failed;
        switch (step_) {
            case Step::PowerOn:
                if (allPowered()) next(Step::HomeZ);
                break;
            case Step::HomeZ:
                return home(machine, Z, Z + 1, Step::HomeXY);
            case Step::HomeXY:
                return home(machine, X, AxisCount, Step::OverSource);
            case Step::OverSource:
                return travel(machine, Source, Step::LowerToSource);
            case Step::LowerToSource:
                return lift(machine, Low, Step::RaiseWithPart);
            case Step::RaiseWithPart:
                return lift(machine, High, Step::OverTarget);
            case Step::OverTarget:
                return travel(machine, target(), Step::LowerToTarget);
            case Step::LowerToTarget:
                return lift(machine, Low, Step::RaiseEmpty);
            case Step::RaiseEmpty:
                return lift(machine, High, Step::NextPart);
            case Step::NextPart:
                ++parts_;
                next(parts_ == Parts ? Step::Park : Step::OverSource);
                break;
            case Step::Park:
                return travel(machine, Home, Step::PowerOff);
            case Step::PowerOff:
                for (auto& power : power_) power.Enable = false;
                if (nonePowered()) return ProgramState::Finished;
                break;
        }
        return ProgramState::Running;
    }

    void describe(takt::Inspector& inspector) override {
        inspector.watch("step", step_);
        inspector.watch("parts", parts_);
    }

private:
    enum class Step : int {
        PowerOn,
        HomeZ,
        HomeXY,
        OverSource,
        LowerToSource,
        RaiseWithPart,
        OverTarget,
        LowerToTarget,
        RaiseEmpty,
        NextPart,
        Park,
        PowerOff,
    };
    struct Place {
        double x, y;  // mm
    };
    static constexpr Place Home{20.0, 20.0};
    static constexpr Place Source{150.0, 80.0};
    static constexpr double High = -10.0;  // mm, down is negative
    static constexpr double Low = -90.0;
    static constexpr int Parts = 3;

    [[nodiscard]] Place target() const { return {600.0, 250.0 + 60.0 * parts_}; }

    /// MC_Power is called in every cycle, whatever else goes on.
    bool keepPowered(takt::Machine& machine) {
        for (std::size_t i = 0; i < AxisCount; ++i) {
            power_[i](axes_[i]);
            if (power_[i].Error) return fail(machine, "an axis lost its power");
        }
        return true;
    }
    [[nodiscard]] bool allPowered() const {
        return power_[X].Status && power_[Y].Status && power_[Z].Status;
    }
    [[nodiscard]] bool nonePowered() const {
        return !power_[X].Status && !power_[Y].Status && !power_[Z].Status;
    }

    ProgramState home(takt::Machine& machine, std::size_t first, std::size_t end, Step then) {
        bool done = true;
        for (std::size_t i = first; i < end; ++i) {
            home_[i].Position = 0.0;
            home_[i].Execute = true;
            home_[i](axes_[i]);
            if (home_[i].Error || home_[i].CommandAborted) {
                fail(machine, "homing failed");
                return ProgramState::Failed;
            }
            done = done && home_[i].Done;
        }
        if (done) next(then);
        return ProgramState::Running;
    }

    ProgramState travel(takt::Machine& machine, Place place, Step then) {
        moveTo(X, place.x, 800.0);
        moveTo(Y, place.y, 800.0);
        return arrived(machine, X, AxisCount, then);
    }

    ProgramState lift(takt::Machine& machine, double height, Step then) {
        moveTo(Z, height, 300.0);
        return arrived(machine, Z, Z + 1, then);
    }

    void moveTo(std::size_t axis, double position, double velocity) {
        move_[axis].Position = position;
        move_[axis].Velocity = velocity;
        move_[axis].Execute = true;
        move_[axis](axes_[axis]);
    }

    ProgramState arrived(takt::Machine& machine, std::size_t first, std::size_t end, Step then) {
        bool done = true;
        for (std::size_t i = first; i < end; ++i) {
            if (move_[i].Error || move_[i].CommandAborted) {
                fail(machine, "a move failed");
                return ProgramState::Failed;
            }
            done = done && move_[i].Done;
        }
        if (!done) return ProgramState::Running;
        // The falling edge makes the blocks ready for the next move.
        for (std::size_t i = first; i < end; ++i) {
            move_[i].Execute = false;
            move_[i](axes_[i]);
        }
        next(then);
        return ProgramState::Running;
    }

    bool fail(takt::Machine& machine, const char* reason) {
        machine.fail(reason);
        return false;
    }
    void next(Step step) { step_ = step; }

    std::array<AxisRef, AxisCount> axes_;
    std::array<takt::MC_Power, AxisCount> power_;
    std::array<takt::MC_Home, AxisCount> home_;
    std::array<takt::MC_MoveAbsolute, AxisCount> move_;
    Step step_{Step::PowerOn};
    int parts_{0};
};

}  // namespace

TAKT_PROGRAM(Gantry)
