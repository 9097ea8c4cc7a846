#pragma once

#include <array>
#include <cstdint>
#include <takt/twin/drive_traits.hpp>

namespace takt::twin {

enum class HomingSpeed : std::uint8_t {
    Fast,
    Slow,
    BackOff,  ///< leaving the switch for another approach: slow or fast, as the drive does it
};

/// What a homing step waits for: an edge of a signal during the step's own motion.
enum class HomingEvent : std::uint8_t {
    HomeOn,
    HomeOff,
    PositiveOn,
    PositiveOff,
    NegativeOn,
    NegativeOff,
    Index,     ///< the next index pulse in the direction of travel
    HardStop,  ///< the motor stands and its current exceeds the threshold
};

enum class HomingAction : std::uint8_t {
    Stop,    ///< ramp to standstill, then the next step
    Go,      ///< the next step at once, without standstill
    Finish,  ///< this event is the home position, found
};

struct HomingStep {
    HomingSpeed speed{HomingSpeed::Slow};
    std::int8_t direction{1};
    HomingEvent event{HomingEvent::Index};
    HomingAction action{HomingAction::Finish};
};

/// The situation in which a row of the table applies.
enum class HomingStart : std::uint8_t {
    Any,
    OffHome,
    OnHome,
    OffPositive,
    OnPositive,
    OffNegative,
    OnNegative,
    OffHomeDirect,  ///< as OffHome, for a drive that takes the first edge without backing off
    LimitFirst,     ///< entered from OffHome when the limit switch comes before the home switch
};

/// The steps of one method from one start situation.
struct HomingSequence {
    static constexpr std::size_t MaxSteps = 5;

    std::int8_t method{0};
    HomingStart start{HomingStart::Any};
    std::uint8_t count{0};
    std::array<HomingStep, MaxSteps> steps{};
};

/// The signals a start situation is judged by.
struct HomingSignals {
    bool home{false};
    bool positive{false};
    bool negative{false};
};

/// Whether the method takes the present position as home, without motion.
[[nodiscard]] constexpr bool homesInPlace(std::int8_t method) noexcept {
    return method == 35 || method == 37;
}

/// rt. Whether a drive with these methods knows the method.
[[nodiscard]] bool homingSupported(HomingMethods methods, std::int8_t method) noexcept;
/// rt. The steps for a method from the present situation; null where the drive's manual describes
/// none, and for methods without motion.
[[nodiscard]] const HomingSequence* findHoming(const HomingTraits& traits, std::int8_t method,
                                               const HomingSignals& signals) noexcept;
/// rt. How the method goes on when the limit switch comes before the home switch; null if it does
/// not.
[[nodiscard]] const HomingSequence* findAfterLimit(std::int8_t method) noexcept;

}  // namespace takt::twin
