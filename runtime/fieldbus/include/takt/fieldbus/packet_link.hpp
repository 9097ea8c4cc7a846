#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <takt/wire/link.hpp>

namespace takt::fieldbus {

/// Frames over a network interface by a raw packet socket (AF_PACKET): a network card or one end of a
/// veth pair. One system call sends all frames of a cycle and one receives them.
class PacketLink : public wire::Link {
public:
    /// Opens the interface and takes it for this process alone.
    /// \param receiveTimeout longest wait of one receive call; the cycle's receive deadline
    /// \param maxFrames most frames of one call
    /// \throw std::runtime_error one line that says what is missing: the interface, that it is down, that
    /// another takt owns it, or the capability CAP_NET_RAW
    PacketLink(const std::string& interface, core::Duration receiveTimeout, std::size_t maxFrames);
    ~PacketLink() override;
    PacketLink(const PacketLink&) = delete;
    PacketLink& operator=(const PacketLink&) = delete;

    wire::LinkStatus send(std::span<wire::Frame> frames) noexcept override;
    /// Arrival stamps are the kernel's where it gives them, else the time of the call's return.
    std::size_t receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept override;

    /// For poll loops of a simulated segment.
    [[nodiscard]] int descriptor() const noexcept { return socket_; }

private:
    void open(const std::string& interface);
    void lockInterface(const std::string& interface);
    void setTimeout(core::Duration timeout) noexcept;
    std::size_t receiveSome(std::span<wire::Frame> slots) noexcept;

    struct Calls;  ///< the arrays of sendmmsg and recvmmsg, set up once

    int socket_{-1};
    int lock_{-1};
    core::Duration timeout_;
    std::unique_ptr<Calls> calls_;
};

}  // namespace takt::fieldbus
