#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <takt/wire/link.hpp>

namespace takt::fieldbus {

/// Frames over a network interface by a raw packet socket (AF_PACKET): a network card or one end of
/// a veth pair. One system call sends all frames of a cycle; waiting for replies is one call as
/// long as they come together, taking them none.
class PacketLink : public wire::Link {
public:
    /// Opens the interface and takes it for this process alone.
    /// \param maxFrames most frames of one call
    /// \throw std::runtime_error one line that says what is missing: the interface, that it is
    /// down, that another takt owns it, or the capability CAP_NET_RAW
    PacketLink(const std::string& interface, std::size_t maxFrames);
    ~PacketLink() override;
    PacketLink(const PacketLink&) = delete;
    PacketLink& operator=(const PacketLink&) = delete;

    wire::LinkStatus send(std::span<wire::Frame> frames) noexcept override;
    /// Arrival stamps are the kernel's, on the monotonic clock.
    std::size_t receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept override;
    /// rt. As `receive`, but returns as soon as there is a frame: for a simulated segment.
    std::size_t receiveAny(std::span<wire::Frame> slots, core::HostTime deadline) noexcept;

private:
    struct Calls;  ///< the socket, its ring and the arrays of sendmmsg, set up once

    std::unique_ptr<Calls> calls_;
};

}  // namespace takt::fieldbus
