/// The sixteen stations of sample 07 go forth and back for ever, each at its own speed.
#include <array>
#include <string>
#include <takt/takt.hpp>

namespace {

constexpr std::size_t Stations = 16;

class EndlessWave : public takt::Program {
public:
    void start(takt::Machine& machine) override {
        for (std::size_t i = 0; i < Stations; ++i) {
            axes_[i] = machine.axis((i < 9 ? "S0" : "S") + std::to_string(i + 1));
            power_[i].Enable = true;
            move_[i].Velocity = 100.0 + 10.0 * static_cast<double>(i);
        }
    }
    takt::ProgramState cycle(takt::Machine& /*machine*/) override {
        for (std::size_t i = 0; i < Stations; ++i) {
            power_[i](axes_[i]);
            if (move_[i].Done) move_[i].Execute = false;
            move_[i](axes_[i]);
            if (move_[i].Execute || !power_[i].Status) continue;
            forth_[i] = !forth_[i];
            move_[i].Position = forth_[i] ? 100.0 : 20.0;
            move_[i].Execute = true;
        }
        return takt::ProgramState::Running;
    }

private:
    std::array<takt::AxisRef, Stations> axes_;
    std::array<takt::MC_Power, Stations> power_;
    std::array<takt::MC_MoveAbsolute, Stations> move_;
    std::array<bool, Stations> forth_{};
};

}  // namespace

TAKT_PROGRAM(EndlessWave)
