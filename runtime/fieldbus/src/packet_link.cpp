#include <takt/fieldbus/packet_link.hpp>

#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <vector>

namespace takt::fieldbus {

namespace {

constexpr std::int64_t NanosPerSecond = 1'000'000'000;

std::int64_t nanos(const timespec& time) noexcept {
    return time.tv_sec * NanosPerSecond + time.tv_nsec;
}

std::int64_t readClock(clockid_t clock) noexcept {
    timespec time{};
    clock_gettime(clock, &time);
    return nanos(time);
}

[[noreturn]] void refuse(const std::string& interface, const std::string& why) {
    throw std::runtime_error("interface '" + interface + "': " + why);
}

}  // namespace

struct PacketLink::Calls {
    using Control = std::array<char, CMSG_SPACE(sizeof(timespec))>;

    explicit Calls(std::size_t count) : messages(count), pieces(count), controls(count) {
        for (std::size_t i = 0; i < count; ++i) {
            messages[i].msg_hdr.msg_iov = &pieces[i];
            messages[i].msg_hdr.msg_iovlen = 1;
        }
    }
    std::vector<mmsghdr> messages;
    std::vector<iovec> pieces;
    std::vector<Control> controls;
};

PacketLink::PacketLink(const std::string& interface, core::Duration receiveTimeout,
                       std::size_t maxFrames)
    : timeout_{receiveTimeout}, calls_{std::make_unique<Calls>(maxFrames)} {
    try {
        open(interface);
        lockInterface(interface);
    } catch (...) {
        if (socket_ >= 0) ::close(socket_);
        if (lock_ >= 0) ::close(lock_);
        throw;
    }
    setTimeout(timeout_);
}

PacketLink::~PacketLink() {
    ::close(socket_);
    ::close(lock_);
}

void PacketLink::open(const std::string& interface) {
    const unsigned index = if_nametoindex(interface.c_str());
    if (index == 0) refuse(interface, "does not exist; `ip link` lists what there is");
    socket_ = ::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, htons(wire::EtherType));
    if (socket_ < 0 && (errno == EPERM || errno == EACCES)) {
        refuse(interface, "no permission to open a raw socket; takt needs the capability CAP_NET_RAW");
    }
    if (socket_ < 0) refuse(interface, std::strerror(errno));

    ifreq request{};
    interface.copy(request.ifr_name, IFNAMSIZ - 1);
    if (ioctl(socket_, SIOCGIFFLAGS, &request) != 0) refuse(interface, std::strerror(errno));
    if ((request.ifr_flags & IFF_UP) == 0) {
        refuse(interface, "is down; do: ip link set " + interface + " up");
    }
    sockaddr_ll address{};
    address.sll_family = AF_PACKET;
    address.sll_protocol = htons(wire::EtherType);
    address.sll_ifindex = static_cast<int>(index);
    if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        refuse(interface, std::strerror(errno));
    }
    // Without this the socket hears what it sends itself.
    const int on = 1;
    if (setsockopt(socket_, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on) != 0) {
        refuse(interface, "the kernel cannot leave out outgoing copies (needs Linux 4.20)");
    }
    setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
}

/// Two masters on one segment would command the same drives (fault F38). An abstract socket name lives and
/// dies with the process and belongs to the network namespace, as the interface does.
void PacketLink::lockInterface(const std::string& interface) {
    lock_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (lock_ < 0) refuse(interface, std::strerror(errno));
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    const std::string text = "takt-interface-" + interface;
    text.copy(name.sun_path + 1, sizeof name.sun_path - 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
    if (::bind(lock_, reinterpret_cast<const sockaddr*>(&name), size) != 0) {
        refuse(interface, "is owned by another takt; stop that one first");
    }
}

void PacketLink::setTimeout(core::Duration timeout) noexcept {
    timeval value{};
    value.tv_sec = timeout.count() / NanosPerSecond;
    value.tv_usec = std::max<std::int64_t>(timeout.count() % NanosPerSecond / 1000, 1);
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &value, sizeof value);
}

wire::LinkStatus PacketLink::send(std::span<wire::Frame> frames) noexcept {
    const std::size_t count = std::min(frames.size(), calls_->messages.size());
    const core::HostTime now{core::Duration{readClock(CLOCK_MONOTONIC)}};
    for (std::size_t i = 0; i < count; ++i) {
        frames[i].stamp = now;
        calls_->pieces[i] = {frames[i].bytes.data(), frames[i].size};
        calls_->messages[i].msg_hdr.msg_control = nullptr;
        calls_->messages[i].msg_hdr.msg_controllen = 0;
    }
    const int sent = sendmmsg(socket_, calls_->messages.data(), static_cast<unsigned>(count), 0);
    if (sent == static_cast<int>(count)) return wire::LinkStatus::Ok;
    return errno == ENETDOWN || errno == ENXIO ? wire::LinkStatus::Down : wire::LinkStatus::SendFailed;
}

std::size_t PacketLink::receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept {
    const std::int64_t left = deadline.time_since_epoch().count() - readClock(CLOCK_MONOTONIC);
    if (left <= 0 || slots.empty()) return 0;
    // The wait is set once; only a caller with another wish (bring-up) costs one more call.
    const core::Duration wish{left};
    if (wish > timeout_ || wish < timeout_ / 2) {
        timeout_ = wish;
        setTimeout(timeout_);
    }
    return receiveSome(slots.first(std::min(slots.size(), calls_->messages.size())));
}

std::size_t PacketLink::receiveSome(std::span<wire::Frame> slots) noexcept {
    for (std::size_t i = 0; i < slots.size(); ++i) {
        calls_->pieces[i] = {slots[i].bytes.data(), slots[i].bytes.size()};
        calls_->messages[i].msg_hdr.msg_control = calls_->controls[i].data();
        calls_->messages[i].msg_hdr.msg_controllen = calls_->controls[i].size();
    }
    const int got = recvmmsg(socket_, calls_->messages.data(), static_cast<unsigned>(slots.size()), 0, nullptr);
    if (got <= 0) return 0;
    // Kernel stamps are wall time; the difference of the clocks at this moment brings them over.
    const std::int64_t monotonic = readClock(CLOCK_MONOTONIC);
    const std::int64_t wallToMonotonic = monotonic - readClock(CLOCK_REALTIME);
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) {
        slots[i].size = static_cast<std::uint16_t>(calls_->messages[i].msg_len);
        std::int64_t arrival = monotonic;
        msghdr& header = calls_->messages[i].msg_hdr;
        for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
            if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
            timespec stamp{};
            std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
            arrival = nanos(stamp) + wallToMonotonic;
        }
        slots[i].stamp = core::HostTime{core::Duration{arrival}};
    }
    return static_cast<std::size_t>(got);
}

}  // namespace takt::fieldbus
