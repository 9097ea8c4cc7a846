#include "tapped_link.hpp"

namespace takt::daemon {

wire::LinkStatus TappedLink::send(std::span<wire::Frame> frames) noexcept {
    const wire::LinkStatus status = inner_.send(frames);
    for (const wire::Frame& frame : frames) {
        capture_.packet(record::Direction::Outbound, frame.stamp, frame.view());
    }
    return status;
}

std::size_t TappedLink::receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept {
    const std::size_t count = inner_.receive(slots, deadline);
    for (const wire::Frame& frame : slots.first(count)) {
        capture_.packet(record::Direction::Inbound, frame.stamp, frame.view());
    }
    return count;
}

}  // namespace takt::daemon
