#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <takt/core/clock_source.hpp>
#include <takt/core/time.hpp>
#include <takt/wire/device_description.hpp>
#include <takt/wire/frame.hpp>
#include <takt/wire/link.hpp>
#include <vector>

/// A line of much simplified devices for tests of the master: plain memory, state changes at once,
/// mailbox answers at once, a clock without drift. Everything that goes wrong is scripted by the
/// test.
namespace takt::test {

class FakeClock final : public core::ClockSource {
public:
    [[nodiscard]] core::HostTime now() const noexcept override { return now_; }
    void sleepUntil(core::HostTime wake) noexcept override {
        if (wake > now_) now_ = wake;
    }

private:
    core::HostTime now_{std::chrono::seconds{1}};
};

struct FakeDevice {
    explicit FakeDevice(const wire::DeviceDescription& device);

    std::vector<std::uint8_t> memory = std::vector<std::uint8_t>(0x10000, 0);
    std::map<std::uint16_t, std::uint32_t> eeprom;  ///< double words by word address
    std::uint16_t mailboxOut{0}, mailboxOutSize{0}, mailboxIn{0}, mailboxInSize{0};
    std::map<std::uint32_t, std::vector<std::uint8_t>> objects;  ///< key index << 8 | sub-index
    std::map<std::uint32_t, std::uint32_t> aborts;   ///< writes and reads refused with a code
    std::vector<std::uint32_t> written;              ///< keys in order of SDO downloads
    std::deque<std::vector<std::uint8_t>> pending;   ///< messages for the in box
    std::map<std::uint8_t, std::uint16_t> refusals;  ///< AL state -> AL status code
    std::uint8_t lastCounter{0};
    std::uint8_t ownCounter{0};
    std::uint32_t receivedMail{0};
    bool dead{false};
    bool mailboxSilent{false};
    bool refusesOutputs{false};
    std::vector<std::uint8_t> lastMessage;
    std::vector<std::uint16_t> stateRequests;  ///< values written to AL control

    void state(std::uint8_t al, std::uint16_t code);
    void emergency(std::uint16_t errorCode);
};

class FakeSegment final : public wire::Link {
public:
    explicit FakeSegment(FakeClock& clock) : clock_{clock} {}

    wire::LinkStatus send(std::span<wire::Frame> frames) noexcept override;
    std::size_t receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept override;

    std::vector<FakeDevice> devices;
    bool down{false};
    std::set<std::uint64_t> lose;  ///< numbers of frames, counted from 0, that never come back
    std::uint64_t frameNumber{0};
    /// Called with every reply before it is queued; may change, drop (return false) or keep it.
    std::function<bool(wire::Frame&, std::uint64_t number)> onReply;
    /// Called with every frame as it was sent.
    std::function<void(const wire::Frame&)> onSend;
    std::deque<wire::Frame> replies;  ///< what receive() hands out next

private:
    void process(wire::Frame& frame);
    void processDatagram(const wire::DatagramView& datagram);
    static bool access(FakeDevice& device, std::uint16_t at, std::span<std::uint8_t> data,
                       bool read, bool write, bool orIn);
    static void registerWritten(FakeDevice& device, std::uint16_t at, std::size_t length);
    static void mailPosted(FakeDevice& device);
    static void refillBox(FakeDevice& device);
    static bool logical(FakeDevice& device, std::uint32_t address, std::span<std::uint8_t> data,
                        std::span<const std::uint8_t> sent, std::uint8_t type);

    FakeClock& clock_;
};

}  // namespace takt::test
