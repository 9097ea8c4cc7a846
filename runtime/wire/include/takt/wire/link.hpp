#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/core/time.hpp>
#include <takt/wire/frame.hpp>

namespace takt::wire {

enum class LinkStatus : std::uint8_t { Ok, Down, SendFailed };

/// The door to one EtherCAT segment. One send and one receive call per cycle, however many frames.
/// Forms: memory (the twin in the same process), a raw packet socket, the replay of a capture.
class Link {
public:
    virtual ~Link() = default;

    /// rt. Sends the frames in order; sets each frame's `stamp` to the send time.
    virtual LinkStatus send(std::span<Frame> frames) noexcept = 0;
    /// rt. Waits until every slot holds a frame or `deadline` has passed. Each frame's `stamp` is
    /// its arrival time. \return how many slots were filled
    virtual std::size_t receive(std::span<Frame> slots, core::HostTime deadline) noexcept = 0;
};

}  // namespace takt::wire
