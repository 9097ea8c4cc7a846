#include <takt/core/monotonic_clock.hpp>
#include <takt/daemon/bus_end.hpp>
#include <takt/fieldbus/packet_link.hpp>
#include <takt/twin/twin.hpp>
#include <vector>

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

std::unique_ptr<BusEnd> interfaceEnd(const std::string& interface, std::size_t framesAtOnce) {
    return std::make_unique<InterfaceEnd>(interface, framesAtOnce);
}

}  // namespace takt::daemon
