#pragma once

#include <array>
#include <cstdint>
#include <takt/twin/drive_traits.hpp>

namespace takt::twin {

enum class HomingSpeed : std::uint8_t { Fast, Slow };

/// What a homing step waits for: an edge of a signal during the step's own motion.
enum class HomingEvent : std::uint8_t {
    HomeOn,
    HomeOff,
    PositiveOn,
    PositiveOff,
    NegativeOn,
    NegativeOff,
    Index,  ///< the next index pulse in the direction of travel
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

enum class HomingStart : std::uint8_t {
    Any,
    HomeOff,
    HomeOn,
    PositiveOff,
    PositiveOn,
    NegativeOff,
    NegativeOn,
};

/// The steps of one method from one start situation.
struct HomingSequence {
    std::int8_t method{0};
    HomingStart start{HomingStart::Any};
    std::uint8_t count{0};
    std::array<HomingStep, 4> steps{};
};

/// The signals a start situation is judged by.
struct HomingSignals {
    bool home{false};
    bool positive{false};
    bool negative{false};
};

inline constexpr std::int8_t HomeAtPresentPosition = 35;

/// rt. Whether the table knows the method, 35 included.
[[nodiscard]] bool homingSupported(HomingTable table, std::int8_t method) noexcept;
/// rt. The steps for a method from the present situation; null for 35 and for unknown methods.
[[nodiscard]] const HomingSequence* findHoming(HomingTable table, std::int8_t method,
                                               const HomingSignals& signals) noexcept;

}  // namespace takt::twin
