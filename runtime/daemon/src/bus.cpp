#include "bus.hpp"

#include <takt/core/monotonic_clock.hpp>
#include <takt/fieldbus/bus_timing.hpp>
#include <takt/fieldbus/packet_link.hpp>
#include <takt/twin/twin.hpp>
#include <utility>

namespace takt::daemon {

namespace {

class SimulatedEnd final : public BusEnd {
public:
    explicit SimulatedEnd(const config::MachineConfig& machine)
        : twin_{machine.twin, machine.twinDevices, machine.network.cycle},
          lost_{machine.twin.faults.lostFrames} {}

    [[nodiscard]] wire::Link& link() noexcept override { return twin_.link(); }
    [[nodiscard]] core::ClockSource& clock() noexcept override { return twin_.clock(); }
    void beginCycle(core::CycleNumber number) noexcept override {
        while (next_ < lost_.size() && number >= lost_[next_].cycle + lost_[next_].cycles) ++next_;
        twin_.cutCable(next_ < lost_.size() && number >= lost_[next_].cycle);
    }

private:
    twin::Twin twin_;
    std::vector<twin::LostFramesParams> lost_;  ///< ascending
    std::size_t next_{0};                       ///< the first that is not over
};

class InterfaceEnd final : public BusEnd {
public:
    InterfaceEnd(const std::string& interface, std::size_t maxFrames)
        : link_{interface, maxFrames} {}

    [[nodiscard]] wire::Link& link() noexcept override { return link_; }
    [[nodiscard]] core::ClockSource& clock() noexcept override { return clock_; }
    void beginCycle(core::CycleNumber) noexcept override {}

private:
    fieldbus::PacketLink link_;
    core::MonotonicClock clock_;
};

}  // namespace

std::unique_ptr<BusEnd> simulatedEnd(const config::MachineConfig& machine) {
    return std::make_unique<SimulatedEnd>(machine);
}

std::unique_ptr<BusEnd> interfaceEnd(const config::MachineConfig& machine,
                                     const std::string& interface) {
    // One more than the cycle needs: what answers late must not keep a reply out.
    const std::size_t frames = fieldbus::computeTiming(machine.network).frames + 1;
    return std::make_unique<InterfaceEnd>(interface, frames);
}

Bus::Bus(const config::MachineConfig& machine, std::unique_ptr<BusEnd> end,
         record::PcapngWriter* capture)
    : end_{std::move(end)} {
    wire::Link* link = &end_->link();
    if (capture != nullptr) {
        tapped_ = std::make_unique<TappedLink>(*link, *capture);
        link = tapped_.get();
    }
    master_ = std::make_unique<fieldbus::ethercat::Master>(machine.network, *link, end_->clock());
}

}  // namespace takt::daemon
