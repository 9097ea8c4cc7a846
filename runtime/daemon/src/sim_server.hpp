#pragma once

#include <atomic>
#include <string>
#include <takt/config/machine_config.hpp>
#include <takt/core/monotonic_clock.hpp>
#include <takt/core/spsc_ring.hpp>
#include <takt/fieldbus/packet_link.hpp>
#include <takt/twin/twin.hpp>
#include <vector>

namespace takt::daemon {

/// How a simulated device stood when it was looked at.
struct SimEvent {
    std::size_t device{0};
    core::TrueTime time{};  ///< since the simulation began
    twin::DeviceProbe probe;
};

/// The twin behind a network interface. True time is the monotonic clock, and a frame acts at the
/// time at which the kernel took it in: a server that is scheduled late answers late, but nothing
/// in the simulated world happens at another time.
class SimServer {
public:
    /// \throw std::runtime_error when the interface cannot be had
    SimServer(const config::MachineConfig& machine, const std::string& interface);

    /// Until stop(). On a thread of its own.
    void serve() noexcept;
    /// From any thread.
    void stop() noexcept { stopped_.store(true, std::memory_order_relaxed); }

    /// One reader. Changes of AL state, error, or drive state since the last call. \return false:
    /// none
    bool next(SimEvent& event) noexcept { return events_.pop(event); }
    /// \pre serve() has returned
    [[nodiscard]] twin::DeviceProbe probe(std::size_t device) const { return twin_.probe(device); }
    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }

private:
    void answer(std::size_t count) noexcept;
    void look(std::size_t device) noexcept;
    [[nodiscard]] core::TrueTime trueAt(core::HostTime time) const noexcept {
        return core::TrueTime{time - origin_};
    }

    twin::Twin twin_;
    fieldbus::PacketLink link_;
    core::MonotonicClock clock_;
    core::HostTime origin_;
    std::vector<wire::Frame> incoming_;
    std::vector<wire::Frame> replies_;
    std::vector<twin::DeviceProbe> seen_;
    std::size_t nextLook_{0};
    std::uint64_t frames_{0};
    core::SpscRing<SimEvent> events_;
    std::atomic<bool> stopped_{false};
};

}  // namespace takt::daemon
