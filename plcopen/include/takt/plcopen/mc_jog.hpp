#pragma once

#include <cstdint>
#include <takt/axis/axis_port.hpp>
#include <takt/axis/command.hpp>
#include <takt/axis/error.hpp>

namespace takt::plcopen {

/// What MC_Jog and MC_Inch have in common: two buttons, motion while a button is held, a ramp to
/// rest when it is let go. After an abort or an error both buttons have to be released before
/// either counts again: an axis never starts by itself because a button is still down.
class ButtonBlock {
public:
    ButtonBlock(const ButtonBlock&) = delete;
    ButtonBlock& operator=(const ButtonBlock&) = delete;

    double Velocity{0.0};      ///< u/s, positive
    double Acceleration{0.0};  ///< u/s², 0 = the axis' default
    double Deceleration{0.0};  ///< u/s², 0 = the axis' default
    double Jerk{0.0};          ///< u/s³, 0 = the axis' default

    bool Done{false};            ///< for one call: at rest again
    bool Busy{false};            ///< from the press until the axis rests
    bool Active{false};          ///< this instance controls the axis
    bool CommandAborted{false};  ///< another command took the axis; until both buttons are released
    bool Error{false};           ///< see ErrorID; until both buttons are released
    axis::ErrorId ErrorID{axis::ErrorId::None};

protected:
    enum class Button : std::int8_t { Backward = -1, None = 0, Forward = 1 };

    ButtonBlock() = default;
    ~ButtonBlock() = default;

    /// rt. The button that counts in this call; none when both are down, and none after an end that
    /// has not been acknowledged by releasing both.
    Button sample(bool forward, bool backward) noexcept;
    /// rt. Where the running command stands; to be asked before anything new is commanded.
    void follow() noexcept;
    /// rt. Commands the axis; a refusal becomes the block's error.
    void submit(const axis::AxisRef& axis, axis::Command command) noexcept;
    /// rt. Ramps the running motion down.
    void halt() noexcept;
    /// rt. Sets Busy and Active for this call.
    void show() noexcept;
    void fail(axis::ErrorId error) noexcept;

    [[nodiscard]] axis::Command move(axis::CommandKind kind) const noexcept;
    [[nodiscard]] bool underWay() const noexcept { return phase_ == axis::CommandPhase::Active; }
    [[nodiscard]] bool halting() const noexcept { return halting_; }

private:
    axis::AxisRef axis_{};
    axis::CommandId id_{axis::CommandId::None};
    axis::CommandPhase phase_{axis::CommandPhase::Unknown};
    bool halting_{false};
    bool locked_{false};  ///< both buttons have to be released first
};

/// Moves the axis with Velocity while exactly one of the buttons is held, and ramps to rest when it
/// is released or both are down. A change of Velocity is followed. Changing over brakes through
/// zero and goes the other way. At an enabled software limit the axis brakes so as to stand on it;
/// further that way is refused with SWLimitReached, back is allowed.
class MC_Jog : public ButtonBlock {
public:
    bool JogForward{false};
    bool JogBackward{false};

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;

private:
    Button direction_{Button::None};  ///< of the running motion
    double velocity_{0.0};            ///< of the running motion
};

/// Each press of a button moves at most Distance; letting go earlier stops earlier. A button that
/// stays down does not repeat.
class MC_Inch : public ButtonBlock {
public:
    bool InchForward{false};
    bool InchBackward{false};
    double Distance{0.0};  ///< u, positive

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;

private:
    Button last_{Button::None};
};

}  // namespace takt::plcopen
