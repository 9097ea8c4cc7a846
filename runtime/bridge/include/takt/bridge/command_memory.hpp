#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <takt/bridge/protocol.hpp>
#include <takt/bridge/shared_memory.hpp>

namespace takt::bridge {

/// The one memory that the bridge may write: commands for the daemon, and how it is doing.
struct CommandLayout {
    using Word = std::atomic<std::uint64_t>;
    static_assert(Word::is_always_lock_free);
    static constexpr std::size_t WordsOfRecord =
        (sizeof(CommandRecord) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);

    alignas(64) Word written{0};    ///< by the bridge: commands so far
    alignas(64) Word taken{0};      ///< by the daemon
    alignas(64) Word published{0};  ///< by the bridge: status samples since it was started
    alignas(64) std::array<std::array<Word, WordsOfRecord>, CommandDepth> records{};
};

/// The bridge's end.
class CommandSender {
public:
    /// \throw std::runtime_error when this is no command memory
    explicit CommandSender(int descriptor);

    /// \return false when the daemon has not yet taken the commands before
    [[nodiscard]] bool send(const CommandRecord& command) noexcept;
    void published(std::uint64_t samples) noexcept {
        memory().published.store(samples, std::memory_order_relaxed);
    }

private:
    [[nodiscard]] CommandLayout& memory() noexcept;

    SharedMemory memory_;
};

/// The daemon's end. Whatever the bridge writes, the counts are bounded here, and a record is
/// copied once and looked at afterwards.
class CommandReceiver {
public:
    CommandReceiver();

    /// The next command whose every field is in its range. \return false when there is none
    [[nodiscard]] bool next(CommandRecord& command) noexcept;
    /// What was no command of this protocol and has been passed over.
    [[nodiscard]] std::uint64_t malformed() const noexcept { return malformed_; }
    [[nodiscard]] std::uint64_t published() const noexcept {
        return memory().published.load(std::memory_order_relaxed);
    }
    /// Before another bridge is started: what the last one left does not count.
    void reset() noexcept;

    [[nodiscard]] int descriptor() const noexcept { return memory_.descriptor(); }

private:
    [[nodiscard]] CommandLayout& memory() noexcept;
    [[nodiscard]] const CommandLayout& memory() const noexcept;

    SharedMemory memory_;
    std::uint64_t taken_{0};  ///< our own count: that in the memory is only told
    std::uint64_t malformed_{0};
};

/// Every field is in its range, texts end inside their arrays and hold printable characters only.
[[nodiscard]] bool isWellFormed(const CommandRecord& command) noexcept;

}  // namespace takt::bridge
