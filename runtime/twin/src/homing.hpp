#pragma once

#include <optional>

#include "homing_sequence.hpp"
#include "motion_generator.hpp"

namespace takt::twin {

/// The numbers of one homing run; turns of the motor shaft and seconds.
struct HomingSettings {
    std::int8_t method{0};
    double fastSpeed{0.0};
    double slowSpeed{0.0};
    double acceleration{0.0};
    double offset{0.0};  ///< move by this after the search, when `movesToOffset`
    double offsetSpeed{0.0};
    bool movesToOffset{false};
    double blockTorque{0.0};  ///< Nm, standing under more than this is a hard stop
    HomingTraits traits;
};

/// Homing inside the drive: an interpreter of the step tables. It is stepped with the control loop
/// and drives a motion generator; the drive asks for the outcome.
class Homing {
public:
    enum class State : std::uint8_t {
        Idle,
        Searching,
        Settling,
        ToOffset,
        Done,
        Interrupted,
        Failed
    };

    /// rt. Starts a run. The generator must hold the present demand.
    void start(const HomingSettings& settings, const Motor& motor,
               MotionGenerator& generator) noexcept;
    /// rt. Switches that count as active beside those of the mechanics: inputs that the controller
    /// feeds in over the bus.
    void force(const HomingSignals& forced) noexcept { forced_ = forced; }
    /// rt. Ramps to standstill.
    void interrupt(MotionGenerator& generator) noexcept;
    /// rt. After each control step, in which the motor was given `torque` (Nm).
    void step(const Motor& motor, double torque, MotionGenerator& generator) noexcept;
    /// rt. Forgets the run.
    void clear() noexcept { state_ = State::Idle; }

    [[nodiscard]] State state() const noexcept { return state_; }
    /// Where home is, in turns. \pre state is ToOffset or Done
    [[nodiscard]] double home() const noexcept { return home_; }
    /// The run ended with a move, and the position is 0 where that ended. \pre state is Done
    [[nodiscard]] std::optional<double> zero() const noexcept { return zero_; }

private:
    void beginStep(const Motor& motor, MotionGenerator& generator) noexcept;
    [[nodiscard]] bool happened(const HomingStep& step, const Motor& motor, double torque,
                                const MotionGenerator& generator) noexcept;
    [[nodiscard]] bool passedIndex(int direction, const Motor& motor) noexcept;
    [[nodiscard]] bool blocked(const HomingStep& step, const Motor& motor) const noexcept;
    [[nodiscard]] double speedOf(const HomingStep& step) const noexcept;
    void act(const HomingStep& step, const Motor& motor, MotionGenerator& generator) noexcept;
    [[nodiscard]] bool turnsAtLimit(const HomingStep& step, const Motor& motor) noexcept;
    void found(const HomingStep& step, const Motor& motor, MotionGenerator& generator) noexcept;
    void settle(const Motor& motor, MotionGenerator& generator) noexcept;
    void arrive(MotionGenerator& generator) noexcept;
    void fail(MotionGenerator& generator) noexcept;
    [[nodiscard]] HomingSignals signalsOf(const Motor& motor) const noexcept;
    void sample(const Motor& motor) noexcept;

    State state_{State::Idle};
    HomingSettings settings_;
    const HomingSequence* sequence_{nullptr};
    std::size_t at_{0};
    bool stopping_{false};
    HomingSignals forced_;
    HomingSignals signals_;  ///< at the last step
    double position_{0.0};   ///< at the last step
    double event_{0.0};      ///< exact place of the last event
    bool eventIsIndex_{false};
    double home_{0.0};
    std::optional<double> zero_;
};

}  // namespace takt::twin
