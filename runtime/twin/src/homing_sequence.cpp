#include "homing_sequence.hpp"

#include <initializer_list>

namespace takt::twin {

namespace {

using enum HomingEvent;
using enum HomingStart;
constexpr auto F = HomingSpeed::Fast;
constexpr auto S = HomingSpeed::Slow;
constexpr auto B = HomingSpeed::BackOff;
constexpr auto Stop = HomingAction::Stop;
constexpr auto Go = HomingAction::Go;
constexpr auto Home = HomingAction::Finish;

constexpr HomingSequence row(int method, HomingStart start,
                             std::initializer_list<HomingStep> steps) {
    HomingSequence result{static_cast<std::int8_t>(method), start, 0, {}};
    for (const HomingStep& step : steps) result.steps[result.count++] = step;
    return result;
}

// The methods that begin towards the positive end; the others are their mirror images. The drives
// differ in the speed of backing off (B) and in the rows named in HomingTraits only.
constexpr std::array PositiveFirst{
    row(2, OffPositive, {{F, 1, PositiveOn, Stop}, {S, -1, PositiveOff, Go}, {S, -1, Index, Home}}),
    row(2, OnPositive, {{S, -1, PositiveOff, Go}, {S, -1, Index, Home}}),
    row(3, OffHome, {{F, 1, HomeOn, Stop}, {S, -1, HomeOff, Go}, {S, -1, Index, Home}}),
    row(3, OnHome, {{S, -1, HomeOff, Go}, {S, -1, Index, Home}}),
    row(4, OffHome, {{F, 1, HomeOn, Go}, {S, 1, Index, Home}}),
    row(4, OnHome, {{B, -1, HomeOff, Stop}, {S, 1, HomeOn, Go}, {S, 1, Index, Home}}),
    row(7, LimitFirst,
        {{F, 1, PositiveOn, Stop},
         {F, -1, HomeOn, Go},
         {S, -1, HomeOff, Go},
         {S, -1, Index, Home}}),
    row(7, OffHome, {{F, 1, HomeOn, Stop}, {S, -1, HomeOff, Go}, {S, -1, Index, Home}}),
    row(7, OnHome, {{S, -1, HomeOff, Go}, {S, -1, Index, Home}}),
    row(8, LimitFirst,
        {{F, 1, PositiveOn, Stop},
         {F, -1, HomeOn, Go},
         {S, -1, HomeOff, Stop},
         {S, 1, HomeOn, Go},
         {S, 1, Index, Home}}),
    row(8, OffHome,
        {{F, 1, HomeOn, Stop}, {S, -1, HomeOff, Stop}, {S, 1, HomeOn, Go}, {S, 1, Index, Home}}),
    row(8, OnHome, {{S, -1, HomeOff, Stop}, {S, 1, HomeOn, Go}, {S, 1, Index, Home}}),
    row(9, LimitFirst, {{F, 1, PositiveOn, Stop}, {F, -1, HomeOn, Go}, {S, -1, Index, Home}}),
    row(9, OffHome,
        {{F, 1, HomeOn, Go}, {S, 1, HomeOff, Stop}, {S, -1, HomeOn, Go}, {S, -1, Index, Home}}),
    row(9, OnHome, {{S, 1, HomeOff, Stop}, {S, -1, HomeOn, Go}, {S, -1, Index, Home}}),
    row(10, LimitFirst,
        {{F, 1, PositiveOn, Stop},
         {F, -1, HomeOn, Stop},
         {S, 1, HomeOff, Go},
         {S, 1, Index, Home}}),
    row(10, OffHome, {{F, 1, HomeOn, Go}, {S, 1, HomeOff, Go}, {S, 1, Index, Home}}),
    row(10, OnHome, {{S, 1, HomeOff, Go}, {S, 1, Index, Home}}),
    row(18, OffPositive, {{F, 1, PositiveOn, Stop}, {S, -1, PositiveOff, Home}}),
    row(18, OnPositive, {{S, -1, PositiveOff, Home}}),
    row(19, OffHome, {{F, 1, HomeOn, Stop}, {S, -1, HomeOff, Home}}),
    row(19, OnHome, {{S, -1, HomeOff, Home}}),
    row(20, OffHome, {{F, 1, HomeOn, Stop}, {B, -1, HomeOff, Stop}, {S, 1, HomeOn, Home}}),
    row(20, OffHomeDirect, {{F, 1, HomeOn, Home}}),
    row(20, OnHome, {{B, -1, HomeOff, Stop}, {S, 1, HomeOn, Home}}),
    row(23, LimitFirst, {{F, 1, PositiveOn, Stop}, {F, -1, HomeOn, Go}, {S, -1, HomeOff, Home}}),
    row(23, OffHome, {{F, 1, HomeOn, Stop}, {S, -1, HomeOff, Home}}),
    row(23, OnHome, {{S, -1, HomeOff, Home}}),
    row(24, LimitFirst,
        {{F, 1, PositiveOn, Stop},
         {F, -1, HomeOn, Go},
         {S, -1, HomeOff, Stop},
         {S, 1, HomeOn, Home}}),
    row(24, OffHome, {{F, 1, HomeOn, Stop}, {S, -1, HomeOff, Stop}, {S, 1, HomeOn, Home}}),
    row(24, OnHome, {{S, -1, HomeOff, Stop}, {S, 1, HomeOn, Home}}),
    row(25, LimitFirst,
        {{F, 1, PositiveOn, Stop},
         {F, -1, HomeOn, Stop},
         {S, 1, HomeOff, Stop},
         {S, -1, HomeOn, Home}}),
    row(25, OffHome, {{F, 1, HomeOn, Go}, {S, 1, HomeOff, Stop}, {S, -1, HomeOn, Home}}),
    row(25, OnHome, {{S, 1, HomeOff, Stop}, {S, -1, HomeOn, Home}}),
    row(26, LimitFirst, {{F, 1, PositiveOn, Stop}, {F, -1, HomeOn, Stop}, {S, 1, HomeOff, Home}}),
    row(26, OffHome, {{F, 1, HomeOn, Go}, {S, 1, HomeOff, Home}}),
    row(26, OnHome, {{S, 1, HomeOff, Home}}),
    row(34, Any, {{S, 1, Index, Home}}),
    row(-18, Any, {{S, 1, HardStop, Home}}),
};

/// The one case that is no mirror image: method 12 takes its index at the first approach, where 8
/// goes back for a second one.
constexpr HomingSequence TwelveSwitchFirst =
    row(12, OffHome, {{F, -1, HomeOn, Go}, {S, -1, Index, Home}});

constexpr std::int8_t mirroredMethod(std::int8_t method) {
    struct Pair {
        std::int8_t positive;
        std::int8_t negative;
    };
    constexpr Pair Pairs[] = {{2, 1},   {3, 5},   {4, 6},   {7, 11},   {8, 12},  {9, 13},
                              {10, 14}, {18, 17}, {19, 21}, {20, 22},  {23, 27}, {24, 28},
                              {25, 29}, {26, 30}, {34, 33}, {-18, -17}};
    for (const Pair& pair : Pairs) {
        if (pair.positive == method) return pair.negative;
    }
    return 0;
}

constexpr HomingStart mirrored(HomingStart start) {
    if (start == OffPositive) return OffNegative;
    return start == OnPositive ? OnNegative : start;
}

constexpr HomingEvent mirrored(HomingEvent event) {
    if (event == PositiveOn) return NegativeOn;
    return event == PositiveOff ? NegativeOff : event;
}

constexpr HomingSequence mirrored(HomingSequence sequence) {
    sequence.method = mirroredMethod(sequence.method);
    if (sequence.method == TwelveSwitchFirst.method && sequence.start == TwelveSwitchFirst.start)
        return TwelveSwitchFirst;
    sequence.start = mirrored(sequence.start);
    for (HomingStep& step : sequence.steps) {
        step.direction = static_cast<std::int8_t>(-step.direction);
        step.event = mirrored(step.event);
    }
    return sequence;
}

constexpr auto makeTable() {
    std::array<HomingSequence, 2 * PositiveFirst.size()> table{};
    for (std::size_t i = 0; i < PositiveFirst.size(); ++i) {
        table[2 * i] = PositiveFirst[i];
        table[2 * i + 1] = mirrored(PositiveFirst[i]);
    }
    return table;
}
constexpr auto Table = makeTable();

bool fits(HomingStart start, const HomingSignals& signals) noexcept {
    switch (start) {
        case HomingStart::Any:
            return true;
        case HomingStart::OffHome:
        case HomingStart::OffHomeDirect:
            return !signals.home;
        case HomingStart::OnHome:
            return signals.home;
        case HomingStart::OffPositive:
            return !signals.positive;
        case HomingStart::OnPositive:
            return signals.positive;
        case HomingStart::OffNegative:
            return !signals.negative;
        case HomingStart::OnNegative:
            return signals.negative;
        case HomingStart::LimitFirst:
            return false;
    }
    return false;
}

const HomingSequence* findRow(std::int8_t method, HomingStart start) noexcept {
    for (const HomingSequence& candidate : Table) {
        if (candidate.method == method && candidate.start == start) return &candidate;
    }
    return nullptr;
}

constexpr bool within(int method, int first, int last) {
    return method >= first && method <= last;
}

/// 4, 6, 20 and 22: home is the edge that is met on the way into the switch.
constexpr bool approachesFromOutside(int method) {
    return method == 4 || method == 6 || method == 20 || method == 22;
}

}  // namespace

bool homingSupported(HomingMethods methods, std::int8_t method) noexcept {
    if (within(method, 1, 6) || within(method, 17, 22) || within(method, 33, 35)) return true;
    if (methods == HomingMethods::WithoutReversal) return false;
    if (within(method, 7, 14) || within(method, 23, 30)) return true;
    return methods == HomingMethods::WithHardStops ? method == -17 || method == -18 : method == 37;
}

const HomingSequence* findHoming(const HomingTraits& traits, std::int8_t method,
                                 const HomingSignals& signals) noexcept {
    if (!homingSupported(traits.methods, method)) return nullptr;
    if (approachesFromOutside(method)) {
        if (traits.startsAsPrinted) return findRow(method, HomingStart::OnHome);
        if (!traits.backsOff && !signals.home) {
            if (const auto* direct = findRow(method, HomingStart::OffHomeDirect)) return direct;
        }
    }
    for (const HomingSequence& candidate : Table) {
        if (candidate.method != method || candidate.start == HomingStart::OffHomeDirect) continue;
        if (!fits(candidate.start, signals)) continue;
        // Methods that turn round at a limit switch: a start on that switch is not described.
        const bool turnsRound = candidate.start == HomingStart::OffHome && findAfterLimit(method);
        const bool atLimit = candidate.steps[0].direction > 0 ? signals.positive : signals.negative;
        return turnsRound && atLimit ? nullptr : &candidate;
    }
    return nullptr;
}

const HomingSequence* findAfterLimit(std::int8_t method) noexcept {
    return findRow(method, HomingStart::LimitFirst);
}

}  // namespace takt::twin
