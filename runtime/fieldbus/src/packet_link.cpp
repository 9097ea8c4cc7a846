#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <takt/fieldbus/packet_link.hpp>
#include <utility>
#include <vector>

#include "packet_ring.hpp"

namespace takt::fieldbus {

namespace {

constexpr std::int64_t NanosPerSecond = 1'000'000'000;

[[noreturn]] void refuse(const std::string& interface, const std::string& why) {
    throw std::runtime_error("interface '" + interface + "': " + why);
}

/// A file descriptor that is closed with the object.
class Descriptor {
public:
    explicit Descriptor(int number) noexcept : number_{number} {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(Descriptor&& other) noexcept : number_{std::exchange(other.number_, -1)} {}
    Descriptor& operator=(Descriptor&&) = delete;

    [[nodiscard]] int number() const noexcept { return number_; }

private:
    int number_;
};

/// Two masters on one segment would command the same drives (fault F38). An abstract socket name
/// lives and dies with the process and belongs to the network namespace, as the interface does.
Descriptor lockInterface(const std::string& interface) {
    Descriptor lock{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
    if (lock.number() < 0) refuse(interface, std::strerror(errno));
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    const std::string text = "takt-interface-" + interface;
    text.copy(name.sun_path + 1, sizeof name.sun_path - 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
    if (::bind(lock.number(), reinterpret_cast<const sockaddr*>(&name), size) != 0) {
        refuse(interface, "is owned by another takt; stop that one first");
    }
    return lock;
}

/// Not bound yet, so that it hears nothing of other interfaces.
Descriptor openSocket(const std::string& interface) {
    if (interface.empty() || interface.size() >= IFNAMSIZ ||
        if_nametoindex(interface.c_str()) == 0) {
        refuse(interface, "does not exist; `ip link` lists what there is");
    }
    Descriptor socket{::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, 0)};
    if (socket.number() < 0 && (errno == EPERM || errno == EACCES)) {
        refuse(interface,
               "no permission to open a raw socket; takt needs the capability CAP_NET_RAW");
    }
    if (socket.number() < 0) refuse(interface, std::strerror(errno));
    ifreq request{};
    interface.copy(request.ifr_name, IFNAMSIZ - 1);
    if (ioctl(socket.number(), SIOCGIFFLAGS, &request) != 0)
        refuse(interface, std::strerror(errno));
    if ((request.ifr_flags & IFF_UP) == 0) {
        refuse(interface, "is down; do: ip link set " + interface + " up");
    }
    return socket;
}

void bindSocket(int socket, const std::string& interface) {
    const int on = 1;
    // Without this the socket hears what it sends itself.
    if (setsockopt(socket, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on) != 0) {
        refuse(interface, "the kernel cannot leave out outgoing copies (needs Linux 4.20)");
    }
    // Both only make things better: stamps where a frame enters the kernel, and no queue before the
    // card.
    setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    setsockopt(socket, SOL_PACKET, PACKET_QDISC_BYPASS, &on, sizeof on);
    sockaddr_ll address{};
    address.sll_family = AF_PACKET;
    address.sll_protocol = htons(wire::EtherType);
    address.sll_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
    if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        refuse(interface, std::strerror(errno));
    }
}

}  // namespace

struct PacketLink::Calls {
    Calls(const std::string& interface, std::size_t maxFrames)
        : socket{openSocket(interface)},
          lock{lockInterface(interface)},
          messages(maxFrames),
          pieces(maxFrames) {
        if (const int error = ring.open(socket.number()); error != 0) {
            refuse(interface, std::string{"no receive ring: "} + std::strerror(error));
        }
        bindSocket(socket.number(), interface);
        for (std::size_t i = 0; i < maxFrames; ++i) {
            messages[i].msg_hdr.msg_iov = &pieces[i];
            messages[i].msg_hdr.msg_iovlen = 1;
        }
    }

    std::size_t takeArrived(std::span<wire::Frame> slots) noexcept {
        std::size_t taken = 0;
        while (taken < slots.size() && ring.take(slots[taken])) {
            if (taken == 0) bridge.update();
            slots[taken].stamp = bridge.toMonotonic(slots[taken].stamp);
            ++taken;
        }
        return taken;
    }

    /// \return false at the deadline or when the link went down
    [[nodiscard]] bool wait(core::HostTime deadline) const noexcept {
        const std::int64_t left = (deadline - monotonicNow()).count();
        if (left <= 0) return false;
        pollfd entry{socket.number(), POLLIN, 0};
        const timespec time{left / NanosPerSecond, left % NanosPerSecond};
        if (ppoll(&entry, 1, &time, nullptr) <= 0) return false;
        if ((entry.revents & POLLERR) == 0) return true;
        // Reading the error clears it; the next send tells whether the link is still down.
        int error = 0;
        socklen_t size = sizeof error;
        getsockopt(socket.number(), SOL_SOCKET, SO_ERROR, &error, &size);
        return false;
    }

    Descriptor socket;
    Descriptor lock;
    PacketRing ring;
    WallClockBridge bridge;
    std::vector<mmsghdr> messages;
    std::vector<iovec> pieces;
};

PacketLink::PacketLink(const std::string& interface, std::size_t maxFrames)
    : calls_{std::make_unique<Calls>(interface, maxFrames)} {}

PacketLink::~PacketLink() = default;

wire::LinkStatus PacketLink::send(std::span<wire::Frame> frames) noexcept {
    const std::size_t count = std::min(frames.size(), calls_->messages.size());
    const core::HostTime now = monotonicNow();
    for (std::size_t i = 0; i < count; ++i) {
        frames[i].stamp = now;
        calls_->pieces[i] = {frames[i].bytes.data(), frames[i].size};
    }
    const int sent =
        sendmmsg(calls_->socket.number(), calls_->messages.data(), static_cast<unsigned>(count), 0);
    if (sent == static_cast<int>(frames.size())) return wire::LinkStatus::Ok;
    const bool down = sent < 0 && (errno == ENETDOWN || errno == ENXIO || errno == ENODEV);
    return down ? wire::LinkStatus::Down : wire::LinkStatus::SendFailed;
}

std::size_t PacketLink::receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept {
    std::size_t filled = calls_->takeArrived(slots);
    // Bounded: every wait but a spurious one brings a frame.
    for (std::size_t waits = 0; filled < slots.size() && waits < 2 * slots.size(); ++waits) {
        if (!calls_->wait(deadline)) break;
        filled += calls_->takeArrived(slots.subspan(filled));
    }
    return filled;
}

std::size_t PacketLink::receiveAny(std::span<wire::Frame> slots, core::HostTime deadline) noexcept {
    const std::size_t filled = calls_->takeArrived(slots);
    if (filled > 0 || !calls_->wait(deadline)) return filled;
    return calls_->takeArrived(slots);
}

}  // namespace takt::fieldbus
