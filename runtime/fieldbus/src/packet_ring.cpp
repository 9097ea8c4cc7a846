#include "packet_ring.hpp"

#include <linux/if_packet.h>
#include <sys/mman.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace takt::fieldbus {

namespace {

constexpr std::int64_t NanosPerSecond = 1'000'000'000;
constexpr std::size_t FrameSize = 2048;  // header, address and 1514 bytes of frame
constexpr std::size_t BlockSize = std::size_t{64} << 10;
constexpr std::size_t Blocks = 8;
constexpr std::size_t Frames = Blocks * BlockSize / FrameSize;
// Reading two clocks takes well below a microsecond unless the thread was interrupted between them.
constexpr std::int64_t GoodReading = 1'000;
constexpr std::int64_t UsableReading = 20'000;

std::int64_t readClock(clockid_t clock) noexcept {
    timespec time{};
    clock_gettime(clock, &time);
    return time.tv_sec * NanosPerSecond + time.tv_nsec;
}

}  // namespace

core::HostTime monotonicNow() noexcept {
    return core::HostTime{core::Duration{readClock(CLOCK_MONOTONIC)}};
}

PacketRing::~PacketRing() {
    if (memory_ != nullptr) munmap(memory_, Blocks * BlockSize);
}

int PacketRing::open(int socket) noexcept {
    const int version = TPACKET_V2;
    if (setsockopt(socket, SOL_PACKET, PACKET_VERSION, &version, sizeof version) != 0) return errno;
    tpacket_req request{};
    request.tp_block_size = BlockSize;
    request.tp_block_nr = Blocks;
    request.tp_frame_size = FrameSize;
    request.tp_frame_nr = Frames;
    if (setsockopt(socket, SOL_PACKET, PACKET_RX_RING, &request, sizeof request) != 0) return errno;
    void* const memory = mmap(nullptr, Blocks * BlockSize, PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_POPULATE, socket, 0);
    if (memory == MAP_FAILED) return errno;
    memory_ = memory;
    return 0;
}

bool PacketRing::take(wire::Frame& to) noexcept {
    // Bounded: each slot is looked at once.
    for (std::size_t tried = 0; tried < Frames; ++tried) {
        auto* const slot = static_cast<std::uint8_t*>(memory_) + next_ * FrameSize;
        auto* const header = reinterpret_cast<tpacket2_hdr*>(slot);
        if ((__atomic_load_n(&header->tp_status, __ATOMIC_ACQUIRE) & TP_STATUS_USER) == 0)
            return false;
        const std::size_t size = header->tp_len;
        const bool whole = size <= wire::MaxFrameSize && header->tp_snaplen == size;
        if (whole) {
            std::copy_n(slot + header->tp_mac, size, to.bytes.begin());
            to.size = static_cast<std::uint16_t>(size);
            to.stamp = core::HostTime{
                core::Duration{std::int64_t{header->tp_sec} * NanosPerSecond + header->tp_nsec}};
        }
        __atomic_store_n(&header->tp_status, std::uint32_t{TP_STATUS_KERNEL}, __ATOMIC_RELEASE);
        next_ = next_ + 1 == Frames ? 0 : next_ + 1;
        if (whole) return true;
    }
    return false;
}

WallClockBridge::WallClockBridge() noexcept {
    constexpr int tries = 50;
    for (int i = 0; i < tries; ++i) {
        if (measure(GoodReading)) return;
    }
    static_cast<void>(measure(NanosPerSecond));
}

void WallClockBridge::update() noexcept {
    // An interrupted reading says nothing; the last good one is off by no more than what the wall
    // clock is being slewed, and a wall clock that was set shows in the next one.
    if (!measure(GoodReading) && !measure(GoodReading)) static_cast<void>(measure(UsableReading));
}

bool WallClockBridge::measure(std::int64_t tolerance) noexcept {
    const std::int64_t before = readClock(CLOCK_MONOTONIC);
    const std::int64_t wall = readClock(CLOCK_REALTIME);
    const std::int64_t after = readClock(CLOCK_MONOTONIC);
    if (after - before > tolerance) return false;
    wallMinusMonotonic_ = wall - before - (after - before) / 2;
    return true;
}

core::HostTime WallClockBridge::toMonotonic(core::HostTime wallStamp) const noexcept {
    const core::HostTime stamp = wallStamp - core::Duration{wallMinusMonotonic_};
    return std::min(stamp, monotonicNow());
}

}  // namespace takt::fieldbus
