#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/axis/command.hpp>

namespace takt::axis {

/// What became of the commands of one port: the program's side of the outcomes.
class CommandBook {
public:
    static constexpr std::size_t Remembered = 64;  ///< commands whose outcome can be asked for

    /// `port` tells the ports of one axis or group apart; 1 to 65535.
    explicit CommandBook(std::uint16_t port) noexcept;

    /// rt. Names a new command that stands at `phase`. \param takesMotion abortPending() ends it
    CommandId add(CommandPhase phase, bool takesMotion) noexcept;
    /// rt. Where the command stands. Unknown when it was never added here or is forgotten.
    [[nodiscard]] CommandStatus status(CommandId id) const noexcept;
    /// rt. The command has neither ended nor been forgotten.
    [[nodiscard]] bool pending(CommandId id) const noexcept;
    /// rt. Commands that take motion and have not ended are aborted.
    void abortPending() noexcept;
    /// rt. Stores what became of a command. Of other ports' commands nothing is kept.
    void note(const CommandEvent& event) noexcept;
    /// rt. Events were lost: pending commands that are not alive become Unknown.
    void forgetAllBut(std::span<const CommandId> alive) noexcept;

private:
    friend class CommandEvents;

    struct Entry {
        CommandId id{CommandId::None};
        CommandStatus status{};
        bool takesMotion{false};
    };

    [[nodiscard]] Entry& entryOf(CommandId id) noexcept {
        return entries_[static_cast<std::size_t>(id) % Remembered];
    }
    [[nodiscard]] const Entry& entryOf(CommandId id) const noexcept {
        return entries_[static_cast<std::size_t>(id) % Remembered];
    }
    [[nodiscard]] CommandId nextId() noexcept;

    std::array<Entry, Remembered> entries_{};
    std::uint64_t lastId_{0};
    std::uint64_t eventsSeen_{0};
};

/// The last outcomes of an axis or a group, for all the ports that sent the commands.
class CommandEvents {
public:
    /// rt. Nothing is kept of a command without a name.
    void report(CommandId id, CommandStatus status) noexcept;
    /// rt. The book has missed some: CommandBook::forgetAllBut() before the next deliver().
    [[nodiscard]] bool missedBy(const CommandBook& book) const noexcept {
        return count_ - book.eventsSeen_ > events_.size();
    }
    /// rt. Hands over what the book has not seen yet.
    void deliver(CommandBook& book) const noexcept;

private:
    std::array<CommandEvent, CommandBook::Remembered> events_{};
    std::uint64_t count_{0};
};

}  // namespace takt::axis
