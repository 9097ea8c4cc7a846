#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <takt/core/time.hpp>
#include <vector>

namespace takt::twin {

/// A switch along the axis: active between two motor positions (in turns from the twin's own zero).
struct SwitchParams {
    double fromTurns{0.0};
    double toTurns{0.0};
};

/// What hangs on one simulated drive. Motor-side numbers; turns are motor turns.
struct MechanicsParams {
    double startTurns{0.0};  ///< where the motor stands at power-up
    double indexTurns{0.0};  ///< position of one index pulse; it repeats every turn
    std::optional<SwitchParams> homeSwitch;
    std::optional<SwitchParams> negativeLimit;
    std::optional<SwitchParams> positiveLimit;
    std::optional<double> hardStopNegative;  ///< turns
    std::optional<double> hardStopPositive;
    double inertia{1.0e-4};  ///< kg·m², motor and load at the motor shaft
    double friction{0.02};   ///< Nm, Coulomb
    double loadTorque{0.0};  ///< Nm, constant (gravity)
};

/// One simulated device. The description comes from the network configuration.
struct TwinDeviceParams {
    std::string slave;                 ///< name on the network
    double clockPpm{0.0};              ///< of the device's own oscillator
    core::Duration clockStart{0};      ///< what its local clock shows at power-up
    core::Duration forwardDelay{600};  ///< input to output port, one way
    core::Duration cableDelay{50};     ///< of the cable before the device
    std::uint32_t subSteps{4};         ///< drive control loops per cycle
    std::int64_t countsPerTurn{
        10000};           ///< drive position units per motor turn, as the drive is set
    std::string profile;  ///< "cd300e", "ra" or "generic"
    MechanicsParams mechanics;
};

/// Frames that get lost between the controller and the first device: those of `cycles` cycles on
/// end.
struct LostFramesParams {
    std::uint64_t cycle{0};  ///< the first one, counted from the start of the cyclic task
    std::uint64_t cycles{1};
};

/// What goes wrong on the simulated machine and when.
struct FaultParams {
    std::vector<LostFramesParams> lostFrames;  ///< in ascending order of cycles
};

struct TwinParams {
    std::vector<TwinDeviceParams> devices;  ///< in frame order, one for each slave of the network
    double hostPpm{0.0};                    ///< of the controller's own clock
    core::Duration wakeJitter{0};           ///< latest a wake-up comes too late
    FaultParams faults;
    std::uint64_t seed{1};
};

}  // namespace takt::twin
