#pragma once

#include <cstdint>
#include <takt/core/time.hpp>
#include <takt/wire/al_state.hpp>

namespace takt::fieldbus::ethercat {

enum class NetworkState : std::uint8_t {
    Off,    ///< before bring-up, or bring-up was refused
    PreOp,  ///< configured, ready for the cyclic phase
    GoingSafeOp,
    SafeOp,  ///< waiting for right working counters and locked clocks
    GoingOp,
    Op,
    GoingDown,
    Init,
    Failed,  ///< `NetworkProblem` tells why; only requestInit and bring-up lead out
};

/// "Off", "PREOP", …
[[nodiscard]] const char* name(NetworkState state) noexcept;

/// Why the network does not go where it was told to. Written in the cycle, put into words outside.
struct NetworkProblem {
    enum class Kind : std::uint8_t {
        None,
        StateRefused,  ///< with the device's AL status code
        StateTimedOut,
        Silent,             ///< the device does not answer
        FellBack,           ///< was in a higher state and left it
        WorkingCounter,     ///< process data never came back with the expected working counter
        ClockNotLocked,     ///< the host did not get onto the SYNC0 grid
        ObjectRefused,      ///< listed object `item`, abort code in `number`
        CommandUnanswered,  ///< listed command `item`; `number` is its working counter
        CommandMismatch,    ///< listed command `item`; `number` has the first bytes read
        DeviceClock,        ///< a device's clock stays away from the reference; `number` in ns
    };
    static constexpr std::uint16_t NoSlave = 0xFFFF;

    Kind kind{Kind::None};
    std::uint16_t slave{NoSlave};
    wire::AlState wanted{wire::AlState::None};
    wire::AlState seen{wire::AlState::None};
    std::uint16_t alStatusCode{0};
    std::int64_t number{0};
    std::uint32_t item{0};
    core::CycleNumber cycle{0};
};

}  // namespace takt::fieldbus::ethercat
