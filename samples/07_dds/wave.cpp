/// Sixteen stations go forth and back one after the other: a wave runs along the line.

#include <array>
#include <cstddef>
#include <string>
#include <takt/takt.hpp>

namespace {

using takt::ProgramState;

constexpr std::size_t Stations = 16;
constexpr int Strokes = 4;                          ///< of each station, forth and back
constexpr double Delay = 0.08;                      ///< s, from one station to the next
constexpr double Period = Stations * Delay;         ///< s, from one wave to the next
constexpr double Far = 120.0;                       ///< mm
constexpr double Velocity = 250.0;                  ///< mm/s
constexpr std::array<double, 2> Targets{Far, 0.0};  ///< of one stroke

/// One station: powered, then a stroke whenever the wave comes by.
class Station {
public:
    void attach(takt::AxisRef axis) {
        axis_ = axis;
        power_.Enable = true;
        move_.Velocity = Velocity;
    }

    /// \param due so many strokes should have begun by now
    void cycle(int due) {
        power_(axis_);
        const bool arrived = move_.Done;
        if (arrived) move_.Execute = false;
        move_(axis_);
        if (move_.Execute || !power_.Status) return;
        if (arrived) next_ = (next_ + 1) % Targets.size();
        if (arrived && next_ == 0) ++strokes_;
        if (next_ == 0 && strokes_ >= due) return;
        move_.Position = Targets[next_];
        move_.Execute = true;
    }
    void switchOff() {
        power_.Enable = false;
        power_(axis_);
    }

    [[nodiscard]] bool failed() const { return power_.Error || move_.Error; }
    [[nodiscard]] bool powered() const { return power_.Status; }
    [[nodiscard]] int strokes() const { return strokes_; }

private:
    takt::AxisRef axis_;
    takt::MC_Power power_;
    takt::MC_MoveAbsolute move_;
    std::size_t next_{0};
    int strokes_{0};
};

class Wave : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        for (std::size_t i = 0; i < Stations; ++i) {
            const std::string number = std::to_string(i + 1);
            stations_[i].attach(machine.axis((i < 9 ? "S0" : "S") + number));
        }
    }

    ProgramState cycle(takt::Machine& machine) override {
        bool allDone = true;
        bool anyPowered = false;
        for (std::size_t i = 0; i < Stations; ++i) {
            Station& station = stations_[i];
            if (off_) {
                station.switchOff();
            } else {
                station.cycle(due(machine.time().count() - static_cast<double>(i) * Delay));
            }
            if (station.failed()) {
                machine.fail("a station does not move");
                return ProgramState::Failed;
            }
            allDone = allDone && station.strokes() == Strokes;
            anyPowered = anyPowered || station.powered();
        }
        if (off_ && !anyPowered) return ProgramState::Finished;
        off_ = off_ || allDone;
        return ProgramState::Running;
    }

    void describe(takt::Inspector& inspector) override { inspector.watch("off", off_); }

private:
    /// Strokes that should have begun `time` after the wave began at a station.
    static int due(double time) {
        constexpr double start = 0.5;
        if (time < start) return 0;
        const int waves = static_cast<int>((time - start) / Period) + 1;
        return waves < Strokes ? waves : Strokes;
    }

    std::array<Station, Stations> stations_;
    bool off_{false};
};

}  // namespace

TAKT_PROGRAM(Wave)
