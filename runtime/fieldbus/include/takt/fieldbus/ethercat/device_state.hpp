#pragma once

#include <cstdint>
#include <takt/wire/al_state.hpp>

namespace takt::fieldbus::ethercat {

/// What is known of the state machine of one device.
struct DeviceState {
    bool answers{false};
    wire::AlState state{wire::AlState::None};
    bool error{false};
    std::uint16_t alStatusCode{0};
    std::uint16_t station{0};
};

}  // namespace takt::fieldbus::ethercat
