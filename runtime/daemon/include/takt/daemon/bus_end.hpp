#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <takt/config/machine_config.hpp>
#include <takt/core/clock_source.hpp>
#include <takt/core/time.hpp>
#include <takt/wire/link.hpp>

namespace takt::daemon {

/// What a network is reached by: a link and the clock that goes with it.
class BusEnd {
public:
    virtual ~BusEnd() = default;
    [[nodiscard]] virtual wire::Link& link() noexcept = 0;
    [[nodiscard]] virtual core::ClockSource& clock() noexcept = 0;
    /// rt. Cycle `number` is about to send.
    virtual void beginCycle(core::CycleNumber number) noexcept = 0;
};

/// A simulated segment in this process, on virtual time.
[[nodiscard]] std::unique_ptr<BusEnd> simulatedEnd(const config::MachineConfig& machine);
/// A network interface, on the monotonic clock. \param framesAtOnce replies that it has room for
/// \throw std::runtime_error one line: what is missing
[[nodiscard]] std::unique_ptr<BusEnd> interfaceEnd(const std::string& interface,
                                                   std::size_t framesAtOnce);

}  // namespace takt::daemon
