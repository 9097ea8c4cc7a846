/// Homing: one axis after the other finds its home by the procedure that the machine file
/// configures for it, then all go together to a place that is told from there.

#include <array>
#include <cstddef>
#include <takt/takt.hpp>

namespace {

using takt::ProgramState;

class HomeAll : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        constexpr std::array<const char*, Count> Names{"Here", "Index", "Switch", "Turn"};
        constexpr std::array<double, Count> Targets{50.0, 50.0, -50.0, 90.0};  // mm, mm, mm, deg
        for (std::size_t i = 0; i < Count; ++i) {
            axes_[i].ref = machine.axis(Names[i]);
            axes_[i].power.Enable = true;
            axes_[i].home.Position = 0.0;  // what the axis shall read at its home
            axes_[i].move.Position = Targets[i];
            axes_[i].move.Velocity = 100.0;
        }
    }

    ProgramState cycle(takt::Machine& machine) override {
        for (Axis& axis : axes_) {
            if (axis.callBlocks()) continue;
            machine.fail("an axis refused a command, did not find its home or lost its power");
            return ProgramState::Failed;
        }
        switch (step_) {
            case Step::PowerOn:
                if (all([](const Axis& axis) { return axis.power.Status; })) step_ = Step::Home;
                break;
            case Step::Home:
                axes_[homed_].home.Execute = true;
                if (axes_[homed_].home.Done && ++homed_ == Count) step_ = Step::Move;
                break;
            case Step::Move:
                for (Axis& axis : axes_) axis.move.Execute = true;
                if (all([](const Axis& axis) { return axis.move.Done; })) step_ = Step::PowerOff;
                break;
            case Step::PowerOff:
                for (Axis& axis : axes_) axis.power.Enable = false;
                if (all([](const Axis& axis) { return !axis.power.Status; }))
                    return ProgramState::Finished;
                break;
        }
        return ProgramState::Running;
    }

    void describe(takt::Inspector& inspector) override {
        inspector.watch("step", step_);
        inspector.watch("homed", homed_);
    }

private:
    enum class Step : int { PowerOn, Home, Move, PowerOff };
    static constexpr std::size_t Count = 4;

    struct Axis {
        takt::AxisRef ref;
        takt::MC_Power power;
        takt::MC_Home home;
        takt::MC_MoveAbsolute move;

        /// \return false when a block has an error
        bool callBlocks() {
            power(ref);
            home(ref);
            move(ref);
            return !power.Error && !home.Error && !move.Error;
        }
    };

    template <typename Condition>
    bool all(Condition holds) const {
        for (const Axis& axis : axes_) {
            if (!holds(axis)) return false;
        }
        return true;
    }

    std::array<Axis, Count> axes_;
    std::size_t homed_{0};
    Step step_{Step::PowerOn};
};

}  // namespace

TAKT_PROGRAM(HomeAll)
