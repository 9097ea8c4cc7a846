/// Carries parts past a fixture: for each way the program names the goal only, a job plans the path
/// around what the machine file says is there, and the group runs it.

#include <array>
#include <cstddef>
#include <takt/takt.hpp>

namespace {

using takt::AxisRef;
using takt::GroupRef;
using takt::ProgramState;

/// Axes in the order in which they home: the tool goes up first.
enum Axis : std::size_t { Z, X, Y, AxisCount };

class AroundTheFixture : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        axes_ = {machine.axis("Z"), machine.axis("X"), machine.axis("Y")};
        tool_ = machine.group("Tool");
        for (auto& power : power_) power.Enable = true;
    }

    ProgramState cycle(takt::Machine& machine) override {
        if (!keepPowered(machine)) return ProgramState::Failed;
        switch (step_) {
            case Step::PowerOn:
                if (allPowered()) step_ = Step::HomeZ;
                break;
            case Step::HomeZ:
                return home(machine, Z, Z + 1, Step::HomeXY);
            case Step::HomeXY:
                return home(machine, X, AxisCount, Step::Enable);
            case Step::Enable:
                enable_.Execute = true;
                enable_(tool_);
                if (enable_.Done) step_ = Step::Plan;
                break;
            case Step::Plan:
                return plan(machine);
            case Step::Move:
                return move(machine);
            case Step::PowerOff:
                for (auto& power : power_) power.Enable = false;
                if (nonePowered()) return ProgramState::Finished;
                break;
        }
        return ProgramState::Running;
    }

    void describe(takt::Inspector& inspector) override {
        inspector.watch("step", step_);
        inspector.watch("goal", goal_);
    }

private:
    enum class Step : int { PowerOn, HomeZ, HomeXY, Enable, Plan, Move, PowerOff };
    struct Place {
        double x, y, z;  // mm, down is negative
    };
    static constexpr std::array<Place, 5> Goals{{
        {180.0, 220.0, -90.0},  // pick up a part
        {700.0, 220.0, -90.0},  // behind fixture, guard and post
        {620.0, 60.0, -90.0},   // on the other side of the post
        {180.0, 220.0, -90.0},  // the next part
        {20.0, 20.0, -10.0},    // park
    }};

    /// MC_Power is called in every cycle, whatever else goes on.
    bool keepPowered(takt::Machine& machine) {
        for (std::size_t i = 0; i < AxisCount; ++i) {
            power_[i](axes_[i]);
            if (power_[i].Error) machine.fail("an axis lost its power");
            if (power_[i].Error) return false;
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
            if (home_[i].Error || home_[i].CommandAborted) return fail(machine, "homing failed");
            done = done && home_[i].Done;
        }
        if (done) step_ = then;
        return ProgramState::Running;
    }

    /// Where to go is all the block is told; it answers some cycles later.
    ProgramState plan(takt::Machine& machine) {
        const Place& goal = Goals[goal_];
        plan_.Goal = {goal.x, goal.y, goal.z};
        plan_.Rounding = 25.0;
        plan_.Seed = 1;
        plan_.Execute = true;
        plan_(tool_, path_);
        if (plan_.Error) return fail(machine, "there is no way to the goal");
        if (!plan_.Done) return ProgramState::Running;
        plan_.Execute = false;
        plan_(tool_, path_);
        step_ = Step::Move;
        return ProgramState::Running;
    }

    ProgramState move(takt::Machine& machine) {
        move_.Velocity = 600.0;
        move_.Execute = true;
        move_(tool_, path_);
        if (move_.Error || move_.CommandAborted) return fail(machine, "the path was not finished");
        if (!move_.Done) return ProgramState::Running;
        move_.Execute = false;
        move_(tool_, path_);
        ++goal_;
        step_ = goal_ == Goals.size() ? Step::PowerOff : Step::Plan;
        return ProgramState::Running;
    }

    static ProgramState fail(takt::Machine& machine, const char* reason) {
        machine.fail(reason);
        return ProgramState::Failed;
    }

    std::array<AxisRef, AxisCount> axes_;
    GroupRef tool_;
    std::array<takt::MC_Power, AxisCount> power_;
    std::array<takt::MC_Home, AxisCount> home_;
    takt::MC_GroupEnable enable_;
    takt::TK_PlanPath plan_;
    takt::MC_MovePath move_;
    takt::MC_PATH_DATA_REF path_;
    Step step_{Step::PowerOn};
    std::size_t goal_{0};
};

}  // namespace

TAKT_PROGRAM(AroundTheFixture)
