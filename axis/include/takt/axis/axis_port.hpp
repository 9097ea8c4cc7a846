#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/axis/axis_view.hpp>
#include <takt/axis/command.hpp>
#include <takt/axis/command_book.hpp>
#include <takt/core/fixed_vector.hpp>
#include <takt/core/result.hpp>

namespace takt::axis {

/// The exchange area of one program with one axis.
///
///     axis.openPort(port);          // the axis: view of this cycle, outcomes of earlier commands
///     port.submit(command);         // the program's blocks: judged and answered at once
///     axis.takeCommands(port);      // the axis: only when the program finished in time
///
/// Only one side touches it at a time: the program between open and take, the axis otherwise. A
/// program that was abandoned may write on; nobody reads it any more.
class AxisPort {
public:
    static constexpr std::size_t MaxCommands = 16;  ///< per program cycle

    /// `number` tells the ports of one axis apart; 1 to 65535.
    explicit AxisPort(std::uint16_t number) noexcept : book_{number} {}
    AxisPort(const AxisPort&) = delete;
    AxisPort& operator=(const AxisPort&) = delete;

    /// rt. The axis as the program sees it; changes with every accepted command.
    [[nodiscard]] const AxisView& view() const noexcept { return view_; }

    /// rt. Judges the request against the view. When accepted the view shows its effect at once and
    /// the axis executes it after the program's cycle. \return the id to ask for (None for commands
    /// without an outcome: power and release of a stop), or why not; then nothing is changed
    [[nodiscard]] core::Result<CommandId, ErrorId> submit(const Command& request) noexcept;

    /// rt. Where the command stands. Unknown when it was never accepted here or is forgotten.
    [[nodiscard]] CommandStatus status(CommandId id) const noexcept { return book_.status(id); }

    /// All handles given out so far become invalid.
    void invalidate() noexcept { ++generation_; }
    [[nodiscard]] std::uint32_t generation() const noexcept { return generation_; }

    // The axis' side.

    /// rt. The commands of this program cycle.
    [[nodiscard]] std::span<const Command> commands() const noexcept {
        return {commands_.begin(), commands_.size()};
    }
    /// rt. Starts a program cycle.
    void open(const AxisView& view) noexcept {
        view_ = view;
        commands_.clear();
    }
    /// rt. Ends it: the commands have been taken.
    void close() noexcept { commands_.clear(); }
    /// rt. What became of its commands.
    [[nodiscard]] CommandBook& book() noexcept { return book_; }

private:
    AxisView view_{};
    core::FixedVector<Command, MaxCommands> commands_{};
    CommandBook book_;
    std::uint32_t generation_{1};
};

/// A small copyable handle of an axis for programs and blocks. A default one, and one whose port
/// was invalidated, is not valid; blocks then answer NullReference.
class AxisRef {
public:
    constexpr AxisRef() noexcept = default;
    /// The port must outlive the handle.
    explicit AxisRef(AxisPort& port) noexcept : port_{&port}, generation_{port.generation()} {}

    /// rt.
    [[nodiscard]] bool valid() const noexcept {
        return port_ != nullptr && port_->generation() == generation_;
    }
    /// rt. \pre valid()
    [[nodiscard]] AxisPort& port() const noexcept { return *port_; }

private:
    AxisPort* port_{nullptr};
    std::uint32_t generation_{0};
};

}  // namespace takt::axis
