#pragma once

#include <memory>
#include <takt/config/machine_config.hpp>
#include <takt/core/clock_source.hpp>
#include <takt/daemon/bus_end.hpp>
#include <takt/fieldbus/ethercat/master.hpp>
#include <takt/record/pcapng_writer.hpp>

#include "tapped_link.hpp"

namespace takt::daemon {

/// The network of a machine: its end and the master that works on it.
class Bus {
public:
    /// \param capture null: no frames are kept
    Bus(const config::MachineConfig& machine, std::unique_ptr<BusEnd> end,
        record::PcapngWriter* capture);

    [[nodiscard]] fieldbus::ethercat::Master& master() noexcept { return *master_; }
    [[nodiscard]] const fieldbus::ethercat::Master& master() const noexcept { return *master_; }
    [[nodiscard]] core::ClockSource& clock() noexcept { return end_->clock(); }
    /// rt.
    void beginCycle(core::CycleNumber number) noexcept { end_->beginCycle(number); }

private:
    std::unique_ptr<BusEnd> end_;
    std::unique_ptr<TappedLink> tapped_;
    std::unique_ptr<fieldbus::ethercat::Master> master_;
};

}  // namespace takt::daemon
