#pragma once

#include <takt/axis/axis_port.hpp>
#include <takt/axis/command.hpp>
#include <takt/axis/error.hpp>
#include <takt/axis/group_port.hpp>
#include <takt/plcopen/enums.hpp>

namespace takt::plcopen {

/// What every Execute-type block has in common, written once: rising edge, exclusivity of the
/// outputs, the one-cycle rule after an early fall of Execute, immediate answer in the call of the
/// edge. `Ref` is what it commands: an axis or a group.
template <typename Ref, typename Command>
class CommandBlock {
public:
    CommandBlock(const CommandBlock&) = delete;
    CommandBlock& operator=(const CommandBlock&) = delete;

    bool Execute{false};  ///< in: a rising edge starts the command and samples all inputs

    bool Busy{false};   ///< out: accepted and not yet finished
    bool Error{false};  ///< out: the command failed or was refused, see ErrorID
    axis::ErrorId ErrorID{axis::ErrorId::None};

protected:
    CommandBlock() = default;
    ~CommandBlock() = default;

    /// rt. One call of the block. `request()` gives what a rising edge commands.
    /// \return where the command stands as this call shows it; Unknown = nothing to show
    template <typename Request>
    axis::CommandPhase run(const Ref& ref, Request&& request) noexcept {
        return runWith(ref, [&request](auto& port, axis::CommandId previous) noexcept {
            Command command = request();
            command.replaces = previous;
            return port.submit(command);
        });
    }
    /// rt. The same, where `submit(port, previous command of the instance)` submits what a rising
    /// edge commands and returns the id that is followed.
    template <typename Submit>
    axis::CommandPhase runWith(const Ref& ref, Submit&& submit) noexcept {
        const bool edge = Execute && !lastExecute_;
        if (edge) {
            accept(ref,
                   ref.valid() ? submit(ref.port(), id_) : Accepted{axis::ErrorId::NullReference});
        } else if (pending_) {
            follow();
        }
        return show(edge);
    }

    [[nodiscard]] axis::CommandId command() const noexcept { return id_; }
    /// Execute was TRUE in the call before.
    [[nodiscard]] bool wasExecuted() const noexcept { return lastExecute_; }

private:
    using Accepted = core::Result<axis::CommandId, axis::ErrorId>;

    void accept(const Ref& ref, const Accepted& accepted) noexcept;
    void follow() noexcept;
    axis::CommandPhase show(bool edge) noexcept;

    Ref ref_{};
    axis::CommandId id_{axis::CommandId::None};
    axis::CommandStatus status_{};
    bool lastExecute_{false};
    bool pending_{false};  ///< accepted and not ended
    bool shown_{false};    ///< the end has been shown in a call
};

extern template class CommandBlock<axis::AxisRef, axis::Command>;
extern template class CommandBlock<axis::GroupRef, axis::GroupCommand>;

/// An Execute-type block that moves what it commands.
template <typename Ref, typename Command>
class MovingBlock : public CommandBlock<Ref, Command> {
public:
    bool Active{false};          ///< out: this instance is in control
    bool CommandAborted{false};  ///< out: another command took control

protected:
    MovingBlock() = default;
    ~MovingBlock() = default;

    /// rt. As CommandBlock::run, and sets Active and CommandAborted.
    template <typename Request>
    axis::CommandPhase runMotion(const Ref& ref, Request&& request) noexcept {
        return showMotion(this->run(ref, request));
    }
    /// rt. Sets Active and CommandAborted as the command stands.
    axis::CommandPhase showMotion(axis::CommandPhase phase) noexcept {
        Active = phase == axis::CommandPhase::Active;
        CommandAborted = phase == axis::CommandPhase::Aborted;
        return phase;
    }
};

using ExecuteBlock = CommandBlock<axis::AxisRef, axis::Command>;
using MotionBlock = MovingBlock<axis::AxisRef, axis::Command>;
using GroupExecuteBlock = CommandBlock<axis::GroupRef, axis::GroupCommand>;
using GroupMotionBlock = MovingBlock<axis::GroupRef, axis::GroupCommand>;

}  // namespace takt::plcopen
