#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <takt/axis/command_book.hpp>
#include <takt/axis/group_command.hpp>
#include <takt/axis/group_view.hpp>
#include <takt/axis/route_desk.hpp>
#include <takt/core/fixed_vector.hpp>
#include <takt/core/result.hpp>
#include <utility>

namespace takt::axis {

/// The exchange area of one program with one group; the same contract as AxisPort.
class GroupPort {
public:
    static constexpr std::size_t MaxCommands = 34;  ///< per program cycle: a whole queue

    /// `number` tells the ports of one group apart; 1 to 65535.
    /// `routes` is the desk of all ports of one program.
    explicit GroupPort(std::uint16_t number,
                       std::shared_ptr<RouteDesk> routes = std::make_shared<RouteDesk>())
        : book_{number}, routes_{std::move(routes)} {}
    GroupPort(const GroupPort&) = delete;
    GroupPort& operator=(const GroupPort&) = delete;

    /// rt. The group as the program sees it; changes with every accepted command.
    [[nodiscard]] const GroupView& view() const noexcept { return view_; }
    /// rt. Judges the request against the view. \return the id to ask for (None for the release of
    /// a stop), or why not; then nothing is changed
    [[nodiscard]] core::Result<CommandId, ErrorId> submit(const GroupCommand& request) noexcept;
    /// rt. Submits commands that belong together: all of them, or none. \pre !requests.empty()
    /// \return the ids of the first and the last
    struct Ids {
        CommandId first;
        CommandId last;
    };
    [[nodiscard]] core::Result<Ids, ErrorId> submit(
        std::span<const GroupCommand> requests) noexcept;
    /// rt. Where ways of this group around its keep-outs are asked for.
    [[nodiscard]] RouteDesk& routes() noexcept { return *routes_; }
    /// rt. Where the command stands.
    [[nodiscard]] CommandStatus status(CommandId id) const noexcept { return book_.status(id); }

    /// All handles given out so far become invalid.
    void invalidate() noexcept { ++generation_; }
    [[nodiscard]] std::uint32_t generation() const noexcept { return generation_; }

    // The group's side.

    /// rt. The commands of this program cycle.
    [[nodiscard]] std::span<const GroupCommand> commands() const noexcept {
        return {commands_.begin(), commands_.size()};
    }
    /// rt. Starts a program cycle.
    void open(const GroupView& view) noexcept {
        view_ = view;
        commands_.clear();
    }
    /// rt. Ends it: the commands have been taken.
    void close() noexcept { commands_.clear(); }
    /// rt. What became of its commands.
    [[nodiscard]] CommandBook& book() noexcept { return book_; }

private:
    GroupView view_{};
    core::FixedVector<GroupCommand, MaxCommands> commands_{};
    CommandBook book_;
    std::shared_ptr<RouteDesk> routes_;
    std::uint32_t generation_{1};
};

/// A small copyable handle of a group for programs and blocks, as AxisRef for an axis.
class GroupRef {
public:
    constexpr GroupRef() noexcept = default;
    /// The port must outlive the handle.
    explicit GroupRef(GroupPort& port) noexcept : port_{&port}, generation_{port.generation()} {}

    /// rt.
    [[nodiscard]] bool valid() const noexcept {
        return port_ != nullptr && port_->generation() == generation_;
    }
    /// rt. \pre valid()
    [[nodiscard]] GroupPort& port() const noexcept { return *port_; }

private:
    GroupPort* port_{nullptr};
    std::uint32_t generation_{0};
};

}  // namespace takt::axis
