#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

namespace takt::twin {

inline constexpr std::size_t MaxSyncManagers = 16;

/// What the end of a frame meant for the device application.
struct SyncManagerEvents {
    std::uint16_t written{0};  ///< bit n: SM n holds a complete new buffer or message of the master
    std::uint16_t taken{0};    ///< bit n: the master has read SM n completely
    std::uint16_t repeated{0};  ///< bit n: the master asks for the last message again
    bool watchdog{false};       ///< a buffer with watchdog trigger was written
};

/// The SyncManagers of a slave controller (ETG.1000.4 clause 6.7): they guard parts of the process
/// RAM as mailboxes (one buffer, hand-shake) or as three-buffer exchange. Channel registers lie at
/// 0x0800.
class SyncManagers {
public:
    /// `registers` and `ram` (from address 0x1000) must outlive the object.
    SyncManagers(std::span<std::uint8_t> registers, std::span<std::uint8_t> ram, std::size_t count);

    /// rt. The master reads or writes RAM; guarded parts follow their SyncManager.
    /// \return whether at least one byte could be accessed
    bool read(std::uint16_t address, std::span<std::uint8_t> data, bool combine) noexcept;
    bool write(std::uint16_t address, std::span<const std::uint8_t> data) noexcept;
    /// rt. End of a frame: completed accesses take effect.
    SyncManagerEvents commit() noexcept;

    /// rt. The master wrote `value` to the byte at `address` (0x0800 …).
    void writeRegister(std::uint16_t address, std::uint8_t value) noexcept;

    // The device application's side.
    [[nodiscard]] bool enabled(std::size_t sm) const noexcept { return channels_[sm].enabled; }
    [[nodiscard]] std::uint16_t start(std::size_t sm) const noexcept { return channels_[sm].start; }
    [[nodiscard]] std::uint16_t length(std::size_t sm) const noexcept {
        return channels_[sm].length;
    }
    [[nodiscard]] bool mailbox(std::size_t sm) const noexcept { return channels_[sm].mailbox; }
    [[nodiscard]] bool masterWrites(std::size_t sm) const noexcept {
        return channels_[sm].masterWrites;
    }
    [[nodiscard]] bool full(std::size_t sm) const noexcept { return channels_[sm].full; }
    /// rt. The newest complete buffer of the master; empty when there is none.
    [[nodiscard]] std::span<const std::uint8_t> newest(std::size_t sm) const noexcept;
    /// rt. The bytes the application shall fill next; `publish` hands them to the master.
    [[nodiscard]] std::span<std::uint8_t> nextBuffer(std::size_t sm) noexcept;
    void publish(std::size_t sm) noexcept;
    /// rt. The message of a full mailbox the master has written; `release` empties the box.
    [[nodiscard]] std::span<const std::uint8_t> message(std::size_t sm) const noexcept;
    void release(std::size_t sm) noexcept;
    /// rt. Puts a message into an empty box. \pre !full(sm), the message fits
    void post(std::size_t sm, std::span<const std::uint8_t> message) noexcept;
    /// rt. Tells the master that its repeat request was served.
    void acknowledgeRepeat(std::size_t sm) noexcept;

private:
    struct Channel {
        std::uint16_t start{0};
        std::uint16_t length{0};
        bool enabled{false};
        bool mailbox{false};
        bool masterWrites{false};
        bool watchdog{false};
        // State
        bool full{false};          ///< mailbox
        bool open{false};          ///< mailbox: first byte accessed, last not yet
        bool completed{false};     ///< last byte accessed in this frame
        bool firstTouched{false};  ///< first byte accessed in this frame
        bool repeatRequested{false};
        std::uint8_t newest{3};      ///< buffered: last complete buffer, 3 = none
        std::uint8_t producing{0};   ///< buffered: buffer being written
        std::uint8_t interrupts{0};  ///< status bits 0 and 1
    };
    static constexpr std::size_t None = MaxSyncManagers;

    void decode(std::size_t sm) noexcept;
    void showStatus(std::size_t sm) noexcept;
    [[nodiscard]] std::size_t guardOf(std::size_t address) const noexcept;
    [[nodiscard]] std::size_t stretchEnd(std::size_t sm, std::size_t address,
                                         std::size_t end) const noexcept;
    [[nodiscard]] std::span<std::uint8_t> buffer(const Channel& channel,
                                                 std::uint8_t number) const noexcept;
    bool readGuarded(Channel& channel, std::size_t offset, std::span<std::uint8_t> data,
                     bool combine) noexcept;
    bool writeGuarded(Channel& channel, std::size_t offset,
                      std::span<const std::uint8_t> data) noexcept;
    bool touch(Channel& channel, std::size_t offset, std::size_t length, bool wantFull) noexcept;
    void complete(std::size_t sm, SyncManagerEvents& events) noexcept;

    std::span<std::uint8_t> registers_;
    std::span<std::uint8_t> ram_;
    std::size_t count_;
    std::array<Channel, MaxSyncManagers> channels_{};
    std::uint16_t touched_{0};  ///< bit n: SM n has something to commit
};

/// rt. Copies, or ORs for broadcast reads, `from` into `to`.
inline void transfer(std::span<std::uint8_t> to, std::span<const std::uint8_t> from,
                     bool combine) noexcept {
    if (!combine) {
        std::copy_n(from.begin(), to.size(), to.begin());
        return;
    }
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<std::uint8_t>(to[i] | from[i]);
}

}  // namespace takt::twin
