#pragma once

#include <memory>
#include <string>
#include <takt/config/machine_config.hpp>
#include <takt/core/clock_source.hpp>
#include <takt/fieldbus/ethercat/master.hpp>
#include <takt/record/pcapng_writer.hpp>
#include <takt/wire/link.hpp>

#include "tapped_link.hpp"

namespace takt::daemon {

/// What a network is reached by: a link and the clock that goes with it.
class BusEnd {
public:
    virtual ~BusEnd() = default;
    [[nodiscard]] virtual wire::Link& link() noexcept = 0;
    [[nodiscard]] virtual core::ClockSource& clock() noexcept = 0;
};

/// A simulated segment in this process, on virtual time.
[[nodiscard]] std::unique_ptr<BusEnd> simulatedEnd(const config::MachineConfig& machine);
/// A network interface, on the monotonic clock.
/// \throw std::runtime_error one line: what is missing
[[nodiscard]] std::unique_ptr<BusEnd> interfaceEnd(const config::MachineConfig& machine,
                                                   const std::string& interface);

/// The network of a machine: its end and the master that works on it.
class Bus {
public:
    /// \param capture null: no frames are kept
    Bus(const config::MachineConfig& machine, std::unique_ptr<BusEnd> end,
        record::PcapngWriter* capture);

    [[nodiscard]] fieldbus::ethercat::Master& master() noexcept { return *master_; }
    [[nodiscard]] core::ClockSource& clock() noexcept { return end_->clock(); }

private:
    std::unique_ptr<BusEnd> end_;
    std::unique_ptr<TappedLink> tapped_;
    std::unique_ptr<fieldbus::ethercat::Master> master_;
};

}  // namespace takt::daemon
