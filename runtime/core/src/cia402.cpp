#include <takt/core/cia402.hpp>

namespace takt::core::cia402 {

const char* name(DriveState state) noexcept {
    switch (state) {
        case DriveState::NotReadyToSwitchOn:
            return "Not ready to switch on";
        case DriveState::SwitchOnDisabled:
            return "Switch on disabled";
        case DriveState::ReadyToSwitchOn:
            return "Ready to switch on";
        case DriveState::SwitchedOn:
            return "Switched on";
        case DriveState::OperationEnabled:
            return "Operation enabled";
        case DriveState::QuickStopActive:
            return "Quick stop active";
        case DriveState::FaultReactionActive:
            return "Fault reaction active";
        case DriveState::Fault:
            return "Fault";
    }
    return "?";
}

}  // namespace takt::core::cia402
