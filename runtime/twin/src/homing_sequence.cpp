#include "homing_sequence.hpp"

#include <span>

namespace takt::twin {

namespace {

using enum HomingEvent;

constexpr HomingStep step(HomingSpeed speed, int direction, HomingEvent event,
                          HomingAction action) {
    return {speed, static_cast<std::int8_t>(direction), event, action};
}
constexpr HomingStep fast(int direction, HomingEvent event,
                          HomingAction action = HomingAction::Stop) {
    return step(HomingSpeed::Fast, direction, event, action);
}
constexpr HomingStep slow(int direction, HomingEvent event,
                          HomingAction action = HomingAction::Finish) {
    return step(HomingSpeed::Slow, direction, event, action);
}

template <typename... Steps>
constexpr HomingSequence sequence(int method, HomingStart start, Steps... steps) {
    return {static_cast<std::int8_t>(method), start, sizeof...(Steps), {steps...}};
}

constexpr auto Go = HomingAction::Go;
constexpr auto Stop = HomingAction::Stop;

// CD300E manual, chapter on homing: "F- NL on, stop; S+ NL off; S+ Z" and so on.
constexpr std::array Cd300eTable{
    sequence(1, HomingStart::NegativeOff, fast(-1, NegativeOn), slow(1, NegativeOff, Go),
             slow(1, Index)),
    sequence(1, HomingStart::NegativeOn, slow(1, NegativeOff, Go), slow(1, Index)),
    sequence(2, HomingStart::PositiveOff, fast(1, PositiveOn), slow(-1, PositiveOff, Go),
             slow(-1, Index)),
    sequence(2, HomingStart::PositiveOn, slow(-1, PositiveOff, Go), slow(-1, Index)),
    sequence(3, HomingStart::HomeOff, fast(1, HomeOn), slow(-1, HomeOff, Go), slow(-1, Index)),
    sequence(3, HomingStart::HomeOn, slow(-1, HomeOff, Go), slow(-1, Index)),
    sequence(4, HomingStart::HomeOff, fast(1, HomeOn, Go), slow(1, Index)),
    sequence(4, HomingStart::HomeOn, slow(-1, HomeOff, Stop), slow(1, HomeOn, Go), slow(1, Index)),
    sequence(5, HomingStart::HomeOff, fast(-1, HomeOn), slow(1, HomeOff, Go), slow(1, Index)),
    sequence(5, HomingStart::HomeOn, slow(1, HomeOff, Go), slow(1, Index)),
    sequence(6, HomingStart::HomeOff, fast(-1, HomeOn, Go), slow(-1, Index)),
    sequence(6, HomingStart::HomeOn, slow(1, HomeOff, Stop), slow(-1, HomeOn, Go), slow(-1, Index)),
    sequence(17, HomingStart::NegativeOff, fast(-1, NegativeOn), slow(1, NegativeOff)),
    sequence(17, HomingStart::NegativeOn, slow(1, NegativeOff)),
    sequence(18, HomingStart::PositiveOff, fast(1, PositiveOn), slow(-1, PositiveOff)),
    sequence(18, HomingStart::PositiveOn, slow(-1, PositiveOff)),
    sequence(19, HomingStart::HomeOff, fast(1, HomeOn), slow(-1, HomeOff)),
    sequence(19, HomingStart::HomeOn, slow(-1, HomeOff)),
    sequence(20, HomingStart::HomeOff, fast(1, HomeOn), slow(-1, HomeOff, Stop), slow(1, HomeOn)),
    sequence(20, HomingStart::HomeOn, slow(-1, HomeOff, Stop), slow(1, HomeOn)),
    sequence(21, HomingStart::HomeOff, fast(-1, HomeOn), slow(1, HomeOff)),
    sequence(21, HomingStart::HomeOn, slow(1, HomeOff)),
    sequence(22, HomingStart::HomeOff, fast(-1, HomeOn), slow(1, HomeOff, Stop), slow(-1, HomeOn)),
    sequence(22, HomingStart::HomeOn, slow(1, HomeOff, Stop), slow(-1, HomeOn)),
    sequence(33, HomingStart::Any, slow(-1, Index)),
    sequence(34, HomingStart::Any, slow(1, Index)),
};

// CiA 402 as the RA manual follows it; 20 and 22 approach the edge at slow speed.
constexpr std::array Cia402Table{
    sequence(1, HomingStart::NegativeOff, fast(-1, NegativeOn), slow(1, NegativeOff, Go),
             slow(1, Index)),
    sequence(1, HomingStart::NegativeOn, slow(1, NegativeOff, Go), slow(1, Index)),
    sequence(2, HomingStart::PositiveOff, fast(1, PositiveOn), slow(-1, PositiveOff, Go),
             slow(-1, Index)),
    sequence(2, HomingStart::PositiveOn, slow(-1, PositiveOff, Go), slow(-1, Index)),
    sequence(3, HomingStart::HomeOff, fast(1, HomeOn), slow(-1, HomeOff, Go), slow(-1, Index)),
    sequence(3, HomingStart::HomeOn, slow(-1, HomeOff, Go), slow(-1, Index)),
    sequence(4, HomingStart::HomeOff, fast(1, HomeOn, Go), slow(1, Index)),
    sequence(4, HomingStart::HomeOn, fast(-1, HomeOff), slow(1, HomeOn, Go), slow(1, Index)),
    sequence(5, HomingStart::HomeOff, fast(-1, HomeOn), slow(1, HomeOff, Go), slow(1, Index)),
    sequence(5, HomingStart::HomeOn, slow(1, HomeOff, Go), slow(1, Index)),
    sequence(6, HomingStart::HomeOff, fast(-1, HomeOn, Go), slow(-1, Index)),
    sequence(6, HomingStart::HomeOn, fast(1, HomeOff), slow(-1, HomeOn, Go), slow(-1, Index)),
    sequence(17, HomingStart::NegativeOff, fast(-1, NegativeOn), slow(1, NegativeOff)),
    sequence(17, HomingStart::NegativeOn, slow(1, NegativeOff)),
    sequence(18, HomingStart::PositiveOff, fast(1, PositiveOn), slow(-1, PositiveOff)),
    sequence(18, HomingStart::PositiveOn, slow(-1, PositiveOff)),
    sequence(19, HomingStart::HomeOff, fast(1, HomeOn), slow(-1, HomeOff)),
    sequence(19, HomingStart::HomeOn, slow(-1, HomeOff)),
    sequence(20, HomingStart::HomeOff, fast(1, HomeOn), fast(-1, HomeOff), slow(1, HomeOn)),
    sequence(20, HomingStart::HomeOn, fast(-1, HomeOff), slow(1, HomeOn)),
    sequence(21, HomingStart::HomeOff, fast(-1, HomeOn), slow(1, HomeOff)),
    sequence(21, HomingStart::HomeOn, slow(1, HomeOff)),
    sequence(22, HomingStart::HomeOff, fast(-1, HomeOn), fast(1, HomeOff), slow(-1, HomeOn)),
    sequence(22, HomingStart::HomeOn, fast(1, HomeOff), slow(-1, HomeOn)),
    sequence(33, HomingStart::Any, slow(-1, Index)),
    sequence(34, HomingStart::Any, slow(1, Index)),
};

std::span<const HomingSequence> rows(HomingTable table) noexcept {
    return table == HomingTable::Cd300e ? std::span<const HomingSequence>{Cd300eTable}
                                        : std::span<const HomingSequence>{Cia402Table};
}

bool fits(HomingStart start, const HomingSignals& signals) noexcept {
    switch (start) {
        case HomingStart::Any:
            return true;
        case HomingStart::HomeOff:
            return !signals.home;
        case HomingStart::HomeOn:
            return signals.home;
        case HomingStart::PositiveOff:
            return !signals.positive;
        case HomingStart::PositiveOn:
            return signals.positive;
        case HomingStart::NegativeOff:
            return !signals.negative;
        case HomingStart::NegativeOn:
            return signals.negative;
    }
    return false;
}

}  // namespace

bool homingSupported(HomingTable table, std::int8_t method) noexcept {
    if (method == HomeAtPresentPosition) return true;
    for (const HomingSequence& row : rows(table)) {
        if (row.method == method) return true;
    }
    return false;
}

const HomingSequence* findHoming(HomingTable table, std::int8_t method,
                                 const HomingSignals& signals) noexcept {
    for (const HomingSequence& row : rows(table)) {
        if (row.method == method && fits(row.start, signals)) return &row;
    }
    return nullptr;
}

}  // namespace takt::twin
