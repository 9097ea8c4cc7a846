/// A rounded rectangle on a plane that leans: four lines and four arcs in space, blended into one
/// path. All segments are asked for at once; how fast each may be run is found by looking ahead.

#include <array>
#include <cstddef>
#include <takt/takt.hpp>

namespace {

using takt::ProgramState;
using takt::plcopen::GroupArray;

class Contour : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        constexpr std::array names{"X", "Y", "Z"};
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            axes_[i] = machine.axis(names[i]);
            power_[i].Enable = true;
        }
        table_ = machine.group("Table");
        enable_.Execute = true;
        prepare();
    }

    ProgramState cycle(takt::Machine& machine) override {
        for (std::size_t i = 0; i < axes_.size(); ++i) power_[i](axes_[i]);
        enable_(table_);
        switch (step_) {
            case Step::PowerOn:
                if (power_[0].Status && power_[1].Status && power_[2].Status) step_ = Step::Home;
                break;
            case Step::Home:
                if (homed()) step_ = Step::ToTheStart;
                break;
            case Step::ToTheStart:
                return run(machine, toStart_, Step::Contour);
            case Step::Contour:
                return runContour(machine);
            case Step::Park:
                return run(machine, park_, Step::PowerOff);
            case Step::PowerOff:
                for (auto& power : power_) power.Enable = false;
                if (!power_[0].Status && !power_[1].Status && !power_[2].Status)
                    return ProgramState::Finished;
                break;
        }
        return ProgramState::Running;
    }

    void describe(takt::Inspector& inspector) override {
        inspector.watch("step", step_);
        inspector.watch("segments", segments_);
    }

private:
    enum class Step : int { PowerOn, Home, ToTheStart, Contour, Park, PowerOff };

    static constexpr double Length = 180.0;  // mm, along the leaning side
    static constexpr double Width = 120.0;
    static constexpr double Radius = 20.0;
    static constexpr double Speed = 200.0;  // mm/s

    /// A place on the leaning plane: it falls by 28 mm in 100 mm.
    static GroupArray onPlane(double u, double v) {
        return {20.0 + 0.96 * u, 20.0 + v, -20.0 - 0.28 * u};
    }

    void prepare() {
        toStart_.Position = onPlane(Radius, 0.0);
        park_.Position = {0.0, 0.0, 0.0};
        constexpr double r = Radius;
        constexpr double s = r * (1.0 - 0.70710678118654752);  // half-way round a corner
        setLine(lines_[0], Length - r, 0.0);
        setArc(arcs_[0], Length - s, s, Length, r);
        setLine(lines_[1], Length, Width - r);
        setArc(arcs_[1], Length - s, Width - s, Length - r, Width);
        setLine(lines_[2], r, Width);
        setArc(arcs_[2], s, Width - s, 0.0, Width - r);
        setLine(lines_[3], 0.0, r);
        setArc(arcs_[3], s, s, r, 0.0);
    }
    template <typename Block>
    static void blend(Block& block) {
        block.Velocity = Speed;
        block.BufferMode = takt::MC_BUFFER_MODE::mcBlendingHigh;
        // Lines and arcs meet in one direction; the contour between them takes the jump of
        // curvature away.
        block.TransitionMode = takt::MC_TRANSITION_MODE::mcTMMaxCornerDeviation;
        block.TransitionParameter = 0.02;
        block.Execute = true;
    }
    static void setLine(takt::MC_MoveLinearAbsolute& line, double u, double v) {
        line.Position = onPlane(u, v);
        blend(line);
    }
    static void setArc(takt::MC_MoveCircularAbsolute& arc, double throughU, double throughV,
                       double u, double v) {
        arc.CircMode = takt::MC_CIRC_MODE::mcBorder;
        arc.AuxPoint = onPlane(throughU, throughV);
        arc.EndPoint = onPlane(u, v);
        blend(arc);
    }

    bool homed() {
        bool done = true;
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            home_[i].Execute = true;
            home_[i](axes_[i]);
            done = done && home_[i].Done;
        }
        return done;
    }

    ProgramState run(takt::Machine& machine, takt::MC_MoveDirectAbsolute& move, Step then) {
        move.Execute = true;
        move(table_);
        if (move.Error || move.CommandAborted) return failed(machine, "a direct move failed");
        if (move.Done) step_ = then;
        return ProgramState::Running;
    }

    ProgramState runContour(takt::Machine& machine) {
        segments_ = 0;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            lines_[i](table_);
            arcs_[i](table_);
            if (lines_[i].Error || arcs_[i].Error) return failed(machine, "a segment failed");
            segments_ += (lines_[i].Done ? 1 : 0) + (arcs_[i].Done ? 1 : 0);
        }
        if (arcs_.back().Done) step_ = Step::Park;
        return ProgramState::Running;
    }

    static ProgramState failed(takt::Machine& machine, const char* why) {
        machine.fail(why);
        return ProgramState::Failed;
    }

    std::array<takt::AxisRef, 3> axes_;
    takt::GroupRef table_;
    std::array<takt::MC_Power, 3> power_;
    std::array<takt::MC_Home, 3> home_;
    takt::MC_GroupEnable enable_;
    takt::MC_MoveDirectAbsolute toStart_;
    takt::MC_MoveDirectAbsolute park_;
    std::array<takt::MC_MoveLinearAbsolute, 4> lines_;
    std::array<takt::MC_MoveCircularAbsolute, 4> arcs_;
    Step step_{Step::PowerOn};
    int segments_{0};
};

}  // namespace

TAKT_PROGRAM(Contour)
