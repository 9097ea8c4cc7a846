#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <takt/core/time.hpp>
#include <vector>

namespace takt::axis {

/// One bit of a device's inputs that stops the machine. A lost input counts as active.
struct MachineStopInput {
    std::string name;   ///< for messages: "X bit 4"
    std::string slave;  ///< name of the device on the network
    std::uint16_t index{0};
    std::uint8_t subindex{0};
    std::uint8_t bit{0};
    bool activeHigh{
        false};  ///< false: the machine runs while the bit is 1, as a closed contact gives it
    std::string origin;  ///< "machine.xml:70"
};

/// The machine stop: all axes ramp down and are switched off (stop category 1).
struct MachineStopParams {
    core::Duration time{
        std::chrono::seconds{3}};  ///< what is still on then is stopped by its drive
    bool onFault{false};  ///< an axis in ErrorStop or a program that failed stops the whole machine
    std::vector<MachineStopInput> inputs;
};

}  // namespace takt::axis
