#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/core/time.hpp>
#include <takt/wire/frame.hpp>
#include <vector>

#include "frame_set.hpp"

namespace takt::fieldbus::ethercat {

/// One acyclic datagram that a state machine wants to send.
struct Request {
    wire::Command command{wire::Command::Nop};
    std::uint16_t adp{0};
    std::uint16_t ado{0};
    std::uint16_t length{0};
    std::span<const std::uint8_t> data{};  ///< at most `length` bytes; zeros follow
};

[[nodiscard]] inline Request readRequest(std::uint16_t station, std::uint16_t address,
                                         std::uint16_t length) noexcept {
    return {wire::Command::Fprd, station, address, length, {}};
}
[[nodiscard]] inline Request writeRequest(std::uint16_t station, std::uint16_t address,
                                          std::span<const std::uint8_t> data) noexcept {
    return {wire::Command::Fpwr, station, address, static_cast<std::uint16_t>(data.size()), data};
}

/// Work that takes several exchanges, one datagram at a time. Bring-up steps it frame by frame, the
/// cyclic phase one slice per cycle.
class AcyclicMachine {
public:
    virtual ~AcyclicMachine() = default;

    /// rt. What it would send now; asking again without take() gives the same.
    /// \return false when it has nothing to send at present
    virtual bool next(core::HostTime now, Request& request) noexcept = 0;
    /// rt. The reply to the datagram that next() named last.
    virtual void take(core::HostTime now, const Reply& reply) noexcept = 0;
    /// rt. Whether next() must be asked again without a new order from outside.
    [[nodiscard]] virtual bool busy() const noexcept = 0;
};

/// Which of many machines have work; asking costs next to nothing when none has.
class WorkSet {
public:
    explicit WorkSet(std::size_t size) : words_((size + 63) / 64) {}

    void set(std::size_t i) noexcept { words_[i / 64] |= std::uint64_t{1} << (i % 64); }
    void clear(std::size_t i) noexcept { words_[i / 64] &= ~(std::uint64_t{1} << (i % 64)); }
    /// rt.
    [[nodiscard]] bool empty() const noexcept {
        std::uint64_t any = 0;
        for (const std::uint64_t word : words_) any |= word;
        return any == 0;
    }
    /// rt. The first member at or after `from`; `none()` when there is none.
    [[nodiscard]] std::size_t firstFrom(std::size_t from) const noexcept {
        for (std::size_t word = from / 64; word < words_.size(); ++word) {
            std::uint64_t bits = words_[word];
            if (word == from / 64) bits &= ~std::uint64_t{0} << (from % 64);
            if (bits != 0) return word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
        }
        return none();
    }
    [[nodiscard]] static constexpr std::size_t none() noexcept { return ~std::size_t{0}; }

private:
    std::vector<std::uint64_t> words_;
};

/// Collects one datagram of every machine that has work, as far as they fit, and hands the replies
/// back. Machines left out come first the next time.
class AcyclicSlice {
public:
    explicit AcyclicSlice(std::size_t machines) : work_{machines}, waiting_{} {
        waiting_.reserve(machines);
    }

    [[nodiscard]] WorkSet& work() noexcept { return work_; }
    /// rt. No machine has work and none waits for a reply.
    [[nodiscard]] bool idle() const noexcept { return work_.empty() && waiting_.empty(); }

    /// rt. Adds at most `budget` bytes of datagrams to the open frame, and to one more frame if
    /// needed.
    void fill(FrameSet& frames, std::span<AcyclicMachine* const> machines, std::size_t budget,
              core::HostTime now) noexcept;
    /// rt. Hands the replies of the exchange to the machines.
    void deliver(const FrameSet& frames, std::span<AcyclicMachine* const> machines,
                 core::HostTime now) noexcept;

    /// rt. How many machines wait for a reply.
    [[nodiscard]] std::size_t waiting() const noexcept { return waiting_.size(); }

private:
    struct Waiting {
        std::uint16_t machine{0};
        DatagramId datagram{0};
    };

    bool add(FrameSet& frames, std::size_t machine, const Request& request,
             std::size_t& budget) noexcept;

    WorkSet work_;
    std::vector<Waiting> waiting_;
    std::size_t start_{0};
};

}  // namespace takt::fieldbus::ethercat
