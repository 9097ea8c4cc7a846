/// Asks for ways that there are not, each for its own reason, and at last for one that there is,
/// which it runs. Finished when every answer is as it must be and comes in its cycle.
#include <array>
#include <string>
#include <takt/takt.hpp>

namespace {

using takt::ProgramState;

class AskForWays : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        axes_ = {machine.axis("X"), machine.axis("Y")};
        group_ = machine.group("G");
        blind_ = machine.group("Blind");
        for (auto& power : power_) power.Enable = true;
        enable_.Execute = true;
        move_.Velocity = 400.0;
    }

    ProgramState cycle(takt::Machine& machine) override {
        for (std::size_t i = 0; i < axes_.size(); ++i) power_[i](axes_[i]);
        if (!power_[0].Status || !power_[1].Status) return ProgramState::Running;
        if (!ready_) {
            home_[0].Execute = home_[1].Execute = true;
            for (std::size_t i = 0; i < axes_.size(); ++i) home_[i](axes_[i]);
            enable_(group_);
            ready_ = home_[0].Done && home_[1].Done && enable_.Done;
            return ProgramState::Running;
        }
        if (question_ < Questions.size()) return ask(machine);
        return run(machine);
    }

private:
    struct Question {
        double x, y;
        bool blind;
        takt::axis::ErrorId error;
        std::uint32_t keepOut;
        std::uint64_t cycles;  ///< from the call with the edge to the answer
    };
    static constexpr std::uint64_t Latency = 20;
    static constexpr std::array<Question, 5> Questions{{
        {90.0, 90.0, false, takt::axis::ErrorId::GoalInKeepOut, 1, Latency},
        {205.0, 250.0, false, takt::axis::ErrorId::GoalInKeepOut, 2, Latency},
        {-1.0, 90.0, false, takt::axis::ErrorId::TargetOutsideSWLimit, 0, Latency},
        {260.0, 260.0, false, takt::axis::ErrorId::RouteNotFound, 0, Latency},
        {260.0, 100.0, true, takt::axis::ErrorId::ObstaclesMissing, 0, 0},
    }};

    ProgramState ask(takt::Machine& machine) {
        const Question& question = Questions[question_];
        if (!plan_.Execute) {
            plan_.Goal = {question.x, question.y};
            plan_.Execute = true;
            asked_ = machine.cycle();
        }
        plan_(question.blind ? blind_ : group_, path_);
        if (plan_.Busy) return ProgramState::Running;
        const bool good = plan_.Error && plan_.ErrorID == question.error &&
                          plan_.KeepOut == question.keepOut &&
                          machine.cycle() - asked_ == question.cycles;
        if (!good) {
            machine.fail("question " + std::to_string(question_) + ": error " +
                         std::to_string(static_cast<int>(plan_.ErrorID)) + " after " +
                         std::to_string(machine.cycle() - asked_) + " cycles");
            return ProgramState::Failed;
        }
        plan_.Execute = false;
        plan_(question.blind ? blind_ : group_, path_);
        ++question_;
        return ProgramState::Running;
    }

    ProgramState run(takt::Machine& machine) {
        if (path_.segments.empty()) {
            plan_.Goal = {260.0, 100.0};
            plan_.Rounding = 10.0;
            plan_.Execute = true;
            plan_(group_, path_);
            if (plan_.Error) machine.fail("no way around the block");
            return plan_.Error ? ProgramState::Failed : ProgramState::Running;
        }
        move_.Execute = true;
        move_(group_, path_);
        if (move_.Error) machine.fail("the way could not be run");
        if (move_.Error) return ProgramState::Failed;
        return move_.Done ? ProgramState::Finished : ProgramState::Running;
    }

    std::array<takt::AxisRef, 2> axes_;
    takt::GroupRef group_;
    takt::GroupRef blind_;
    std::array<takt::MC_Power, 2> power_;
    std::array<takt::MC_Home, 2> home_;
    takt::MC_GroupEnable enable_;
    takt::TK_PlanPath plan_;
    takt::MC_MovePath move_;
    takt::MC_PATH_DATA_REF path_;
    std::size_t question_{0};
    std::uint64_t asked_{0};
    bool ready_{false};
};

}  // namespace

TAKT_PROGRAM(AskForWays)
