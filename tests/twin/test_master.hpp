#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <takt/twin/twin.hpp>
#include <takt/wire/frame.hpp>
#include <vector>

namespace takt::twin::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes le16(std::uint32_t v) {
    return {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v >> 8)};
}
inline Bytes le32(std::uint32_t v) {
    return {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v >> 8),
            static_cast<std::uint8_t>(v >> 16), static_cast<std::uint8_t>(v >> 24)};
}
inline Bytes le64(std::uint64_t v) {
    Bytes b = le32(static_cast<std::uint32_t>(v));
    const Bytes high = le32(static_cast<std::uint32_t>(v >> 32));
    b.insert(b.end(), high.begin(), high.end());
    return b;
}
inline std::uint64_t number(std::span<const std::uint8_t> b) {
    std::uint64_t v = 0;
    for (std::size_t i = 0; i < b.size(); ++i) v |= std::uint64_t{b[i]} << (8 * i);
    return v;
}
inline std::int32_t signed32(std::uint64_t v) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(v));
}

struct Reply {
    bool arrived{false};
    std::uint16_t wkc{0};
    std::uint16_t adp{0};
    std::uint16_t irq{0};
    Bytes data;
};

struct SdoReply {
    std::uint32_t abort{0};
    Bytes data;
};

/// The few lines of a master that the tests need; written against the standard, one datagram at a
/// time.
class TestMaster {
public:
    explicit TestMaster(Twin& twin) : twin_{twin} {}

    Reply send(wire::Command command, std::uint16_t adp, std::uint16_t ado, const Bytes& data);
    Reply logical(wire::Command command, std::uint32_t address, const Bytes& data);
    Reply read(std::size_t device, std::uint16_t ado, std::size_t size) {
        return send(wire::Command::Fprd, station(device), ado, Bytes(size, 0));
    }
    Reply write(std::size_t device, std::uint16_t ado, const Bytes& data) {
        return send(wire::Command::Fpwr, station(device), ado, data);
    }
    static std::uint16_t station(std::size_t device) {
        return static_cast<std::uint16_t>(1001 + device);
    }
    void sleep(core::Duration time) { twin_.clock().sleepUntil(twin_.clock().now() + time); }

    void addressAll();
    Bytes readSii(std::size_t device, std::uint32_t word);
    /// Requests an AL state and waits until it is reached or refused. \return AL status and code
    std::pair<std::uint16_t, std::uint16_t> requestState(
        std::size_t device, std::uint16_t control,
        core::Duration patience = std::chrono::milliseconds{50});
    void setMailboxes(std::size_t device);
    void setProcessData(std::size_t device, std::uint16_t outputs = 7, std::uint16_t inputs = 13);
    /// INIT to PREOP for all.
    void toPreOp();

    /// One mailbox exchange; empty when no answer came.
    Bytes mailbox(std::size_t device, const Bytes& message);
    SdoReply upload(std::size_t device, std::uint16_t index, std::uint8_t subindex);
    std::uint32_t download(std::size_t device, std::uint16_t index, std::uint8_t subindex,
                           const Bytes& data);

    /// Delays, offsets and drift compensation as the standard describes them.
    void setUpClocks(int driftFrames);
    void startSync0(core::Duration cycle, core::Duration shift);

    /// One bus cycle with FRMW and LRW of all devices at the next beat.
    void cycle();
    void cycles(int count) {
        for (int i = 0; i < count; ++i) cycle();
    }
    /// All devices through SAFEOP to OP with DC.
    void toOp(core::Duration cycleTime = std::chrono::milliseconds{1});

    [[nodiscard]] std::uint16_t statusWord(std::size_t device) const {
        return static_cast<std::uint16_t>(input(device, 2, 2));
    }
    [[nodiscard]] std::int32_t position(std::size_t device) const {
        return signed32(input(device, 5, 4));
    }
    [[nodiscard]] std::int32_t lag(std::size_t device) const {
        return signed32(input(device, 9, 4));
    }
    [[nodiscard]] std::uint16_t errorCode(std::size_t device) const {
        return static_cast<std::uint16_t>(input(device, 0, 2));
    }
    [[nodiscard]] std::int8_t mode(std::size_t device) const {
        return static_cast<std::int8_t>(input(device, 4, 1));
    }
    void command(std::size_t device, std::uint16_t controlWord, std::int8_t mode,
                 std::int32_t target);
    /// Shutdown, switch on, enable, with the target at the actual position.
    bool enable(std::size_t device, std::int8_t mode);

    std::uint16_t lastWkc{0};
    std::vector<Bytes> trace;  ///< every frame sent and received, when `tracing`
    bool tracing{false};

private:
    [[nodiscard]] std::uint64_t input(std::size_t device, std::size_t at, std::size_t size) const;
    Reply exchange(wire::Frame& frame, wire::DatagramPlace place);

    Twin& twin_;
    std::uint8_t index_{0};
    std::uint8_t counter_{0};
    std::uint16_t outSize_{7};
    std::uint16_t inSize_{13};
    core::Duration beat_{std::chrono::milliseconds{1}};
    std::optional<core::HostTime> nextBeat_;
    Bytes outputs_;
    Bytes inputs_;
    wire::Frame frame_;
    wire::Frame slot_;
};

}  // namespace takt::twin::test
