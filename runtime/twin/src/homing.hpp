#pragma once

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
    HomeReference reference{HomeReference::LatchedEdge};
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
    void start(const HomingSettings& settings, HomingTable table, const Motor& motor,
               MotionGenerator& generator) noexcept;
    /// rt. Ramps to standstill.
    void interrupt(MotionGenerator& generator) noexcept;
    /// rt. After each control step.
    void step(const Motor& motor, MotionGenerator& generator) noexcept;
    /// rt. Forgets the run.
    void clear() noexcept { state_ = State::Idle; }

    [[nodiscard]] State state() const noexcept { return state_; }
    /// Where home is, in turns. \pre state is ToOffset or Done
    [[nodiscard]] double home() const noexcept { return home_; }
    [[nodiscard]] const HomingSettings& settings() const noexcept { return settings_; }

private:
    void beginStep(const Motor& motor, MotionGenerator& generator) noexcept;
    [[nodiscard]] bool happened(HomingEvent event, int direction, const Motor& motor) noexcept;
    [[nodiscard]] bool blocked(const HomingStep& step, const Motor& motor) const noexcept;
    void found(const Motor& motor, MotionGenerator& generator) noexcept;
    void settle(const Motor& motor, MotionGenerator& generator) noexcept;
    void arrive(MotionGenerator& generator) noexcept;
    void fail(MotionGenerator& generator) noexcept;
    void sample(const Motor& motor) noexcept;

    State state_{State::Idle};
    HomingSettings settings_;
    const HomingSequence* sequence_{nullptr};
    std::size_t at_{0};
    bool stopping_{false};
    HomingSignals signals_;  ///< at the last step
    double position_{0.0};   ///< at the last step
    double event_{0.0};      ///< exact place of the last event
    bool eventIsIndex_{false};
    double home_{0.0};
};

}  // namespace takt::twin
