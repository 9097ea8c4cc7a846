#pragma once

#include <takt/axis/axis_port.hpp>
#include <takt/axis/command.hpp>
#include <takt/axis/error.hpp>
#include <takt/plcopen/enums.hpp>

namespace takt::plcopen {

/// What every Execute-type block has in common, written once: rising edge, exclusivity of the
/// outputs, the one-cycle rule after an early fall of Execute, immediate answer in the call of the
/// edge.
class ExecuteBlock {
public:
    ExecuteBlock(const ExecuteBlock&) = delete;
    ExecuteBlock& operator=(const ExecuteBlock&) = delete;

    bool Execute{false};  ///< in: a rising edge starts the command and samples all inputs

    bool Busy{false};   ///< out: accepted and not yet finished
    bool Error{false};  ///< out: the command failed or was refused, see ErrorID
    axis::ErrorId ErrorID{axis::ErrorId::None};

protected:
    ExecuteBlock() = default;
    ~ExecuteBlock() = default;

    /// rt. One call of the block. `request()` gives what a rising edge commands.
    /// \return where the command stands as this call shows it; Unknown = nothing to show
    template <typename Request>
    axis::CommandPhase run(const axis::AxisRef& axis, Request&& request) noexcept {
        const bool edge = Execute && !lastExecute_;
        if (edge) {
            start(axis, request());
        } else if (pending_) {
            follow();
        }
        return show(edge);
    }

    [[nodiscard]] axis::CommandId command() const noexcept { return id_; }
    /// Execute was TRUE in the call before.
    [[nodiscard]] bool wasExecuted() const noexcept { return lastExecute_; }

private:
    void start(const axis::AxisRef& axis, const axis::Command& request) noexcept;
    void follow() noexcept;
    axis::CommandPhase show(bool edge) noexcept;

    axis::AxisRef axis_{};
    axis::CommandId id_{axis::CommandId::None};
    axis::CommandStatus status_{};
    bool lastExecute_{false};
    bool pending_{false};  ///< accepted and not ended
    bool shown_{false};    ///< the end has been shown in a call
};

/// An Execute-type block that moves the axis.
class MotionBlock : public ExecuteBlock {
public:
    bool Active{false};          ///< out: this instance controls the axis
    bool CommandAborted{false};  ///< out: another command took the axis

protected:
    MotionBlock() = default;
    ~MotionBlock() = default;

    /// rt. As ExecuteBlock::run, and sets Active and CommandAborted.
    template <typename Request>
    axis::CommandPhase runMotion(const axis::AxisRef& axis, Request&& request) noexcept {
        const axis::CommandPhase phase = run(axis, request);
        Active = phase == axis::CommandPhase::Active;
        CommandAborted = phase == axis::CommandPhase::Aborted;
        return phase;
    }
};

}  // namespace takt::plcopen
