#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <takt/axis/axis_params.hpp>
#include <takt/core/cia402.hpp>
#include <takt/core/object_access.hpp>
#include <takt/core/process_image.hpp>

namespace takt::test {

/// A CiA 402 drive made of the standard's tables, for tests of the master side: bytes in, bytes
/// out, one frame of delay each way and one cycle from target to motor.
class SimDrive {
public:
    SimDrive();

    [[nodiscard]] core::DeviceImage image() { return {inputs, outputs, &health}; }
    [[nodiscard]] static axis::DriveBindings bindings();

    /// One bus cycle: the frame delivers what was latched before and takes the master's outputs.
    void exchange();

    // Knobs.
    std::int64_t position{0};    ///< motor, counts
    bool enableInput{true};      ///< STO and enable input
    std::uint16_t faultCode{0};  ///< not 0: the drive is in fault
    bool faultResettable{true};
    std::optional<std::int64_t> blockedAt;  ///< the motor stands here whatever is asked
    std::int64_t drift{0};         ///< counts per cycle the motor is pushed while nobody holds it
    bool refuseEnable{false};      ///< never leaves Switched on
    bool frameLost{false};         ///< the next frames do not come back
    int enableDelay{2};            ///< cycles from the order to Operation enabled
    std::int8_t fixedMode{0};      ///< not 0: 6061h shows this, whatever is asked
    std::int64_t homingTravel{0};  ///< counts to move before the reference
    std::int64_t homingZeroAt{0};  ///< counts left on the position when homing is done
    bool homingFails{false};
    bool homingNeverEnds{false};
    bool keepsHomingBits{true};       ///< the result stays visible until the next start
    std::uint32_t quickStopStep{50};  ///< counts per cycle lost per cycle in a quick stop

    // What was seen.
    core::cia402::DriveState state{core::cia402::DriveState::SwitchOnDisabled};
    std::uint16_t controlword{0};
    std::int32_t target{0};
    std::int8_t mode{0};
    int resetEdges{0};
    std::optional<std::int64_t> firstTargetAfterEnable;
    std::optional<std::int64_t> positionAtEnable;
    std::int64_t worstStep{0};  ///< largest jump of the motor in one cycle while it follows targets

    std::array<std::uint8_t, 16> inputs{};
    std::array<std::uint8_t, 16> outputs{};
    core::DeviceHealth health{true, true, 0, 0};

private:
    void takeOutputs();
    void stepState();
    void stepMotor();
    void stepHoming();
    void latchInputs();
    [[nodiscard]] std::uint16_t statusword() const;

    std::array<std::uint8_t, 16> latched_{};
    std::uint16_t lastControlword_{0};
    std::int64_t pendingTarget_{0};
    std::int64_t lastStep_{0};
    int delay_{0};
    bool homingRuns_{false};
    bool homingDone_{false};
    bool homingError_{false};
    std::int64_t homingLeft_{0};
};

}  // namespace takt::test
