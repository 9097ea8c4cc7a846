#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <takt/axis/axis.hpp>
#include <takt/plcopen/plcopen.hpp>

#include "sim_drive.hpp"

using namespace takt;

namespace {

axis::AxisParams benchParams() {
    axis::AxisParams p;
    p.name = "X";
    p.unit = "mm";
    p.scaling.countsPerTurn = 10000;
    p.scaling.unitsPerTurnNumerator = 20;
    p.limits.velocity = core::Velocity{500.0};
    p.limits.acceleration = core::Acceleration{5000.0};
    p.limits.deceleration = core::Acceleration{4000.0};
    p.limits.jerk = core::Jerk{100000.0};
    p.limits.stopDeceleration = core::Acceleration{8000.0};
    p.limits.stopJerk = core::Jerk{400000.0};
    p.limits.softPositive = core::Position{5000.0};
    p.limits.softNegative = core::Position{-5000.0};
    p.supervision.followingError = core::Distance{1.0};
    p.supervision.driveDelayCycles = 1;
    return p;
}

/// One axis with its drive and a program of two blocks.
struct Station {
    Station() : x{benchParams(), std::chrono::milliseconds{1}} {
        x.attach(drive.image(), test::SimDrive::bindings(), nullptr);
        power.Enable = true;
        move.Position = 700.0;
        move.Velocity = 400.0;
    }

    test::SimDrive drive;
    axis::Axis x;
    axis::AxisPort port{1};
    plcopen::MC_Power power;
    plcopen::MC_MoveAbsolute move;
    std::uint64_t k{0};
};

}  // namespace

// What callgrind counts; a C name, so that it finds it.
extern "C" {

/// The whole way of one axis through one cycle: decode, supervise, block, set-point, encode.
__attribute__((noinline)) void countedCycle(Station& s, axis::AxisRef ref) {
    s.x.readInputs(s.k);
    s.x.openPort(s.port);
    s.move(ref);
    s.x.takeCommands(s.port);
    s.x.step();
    s.x.writeOutputs();
}
}

/// axis_count cycle CYCLES: that many cycles of a move, from its beginning (1800 in all).
int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const int cycles = std::atoi(argv[2]);
    Station s;
    const axis::AxisRef ref{s.port};
    const auto warmUp = [&] {
        ++s.k;
        s.drive.exchange();
        s.x.readInputs(s.k);
        s.x.openPort(s.port);
        s.power(ref);
        s.move(ref);
        s.x.takeCommands(s.port);
        s.x.step();
        s.x.writeOutputs();
    };
    for (int i = 0; i < 50; ++i) warmUp();
    s.move.Execute = true;
    warmUp();
    for (int i = 0; i < cycles; ++i) {
        ++s.k;
        s.drive.exchange();
        countedCycle(s, ref);
    }
    const axis::AxisStatus status = s.x.status();
    std::printf("%.17g\n", status.set.count());
    return s.move.Busy && status.setVelocity.count() > 0.0 ? 0 : 1;
}
