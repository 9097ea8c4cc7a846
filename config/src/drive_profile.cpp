#include "drive_profile.hpp"

#include <algorithm>
#include <array>

namespace takt::config {

namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::array<core::Duration, 7> Cd300eCycles{
    microseconds{125}, microseconds{250}, microseconds{500}, milliseconds{1},
    milliseconds{2},   milliseconds{4},   milliseconds{8}};

constexpr std::array<std::int8_t, 33> Cd300eHoming{-18, -17, 1,  2,  3,  4,  5,  6,  7,  8,  9,
                                                   10,  11,  12, 13, 14, 17, 18, 19, 20, 21, 22,
                                                   23,  24,  25, 26, 27, 28, 29, 30, 33, 34, 35};
constexpr std::array<std::int8_t, 15> RaHoming{1,  2,  3,  4,  5,  6,  17, 18,
                                               19, 20, 21, 22, 33, 34, 35};
// CiA 402: 1 to 14, 17 to 30, 33 to 35 and 37; 15, 16, 31, 32 are reserved, 36 was withdrawn.
constexpr std::array<std::int8_t, 32> StandardHoming{1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11,
                                                     12, 13, 14, 17, 18, 19, 20, 21, 22, 23, 24,
                                                     25, 26, 27, 28, 29, 30, 33, 34, 35, 37};

constexpr std::array<DriveProfile, 3> Profiles{
    DriveProfile{"cd300e", "CD300", axis::DriveVelocityUnit::CountsPerSecond, 10'000, 0,
                 Cd300eCycles, core::Duration{0}, core::Duration{0},
                 "125 us, 250 us, 500 us, 1 ms, 2 ms, 4 ms, 8 ms", Cd300eHoming,
                 "-18, -17, 1 to 14, 17 to 30, 33, 34, 35", 1,
                 "is not documented, and its stop options are delivered as coasting"},
    DriveProfile{"ra",
                 "RA",
                 axis::DriveVelocityUnit::TenthRpm,
                 32'768,
                 32,
                 {},
                 microseconds{125},
                 milliseconds{16},
                 "multiples of 125 us up to 16 ms",
                 RaHoming,
                 "1 to 6, 17 to 22, 33, 34, 35",
                 0,
                 "is not documented, and it has no stop option objects"},
    DriveProfile{"generic",
                 "",
                 axis::DriveVelocityUnit::CountsPerSecond,
                 0,
                 0,
                 {},
                 core::Duration{0},
                 core::Duration{0},
                 "any",
                 StandardHoming,
                 "1 to 14, 17 to 30, 33, 34, 35, 37",
                 2,
                 "is not known for this drive"},
};

}  // namespace

const DriveProfile* findProfile(std::string_view name) noexcept {
    for (const DriveProfile& profile : Profiles) {
        if (profile.name == name) return &profile;
    }
    return nullptr;
}

const DriveProfile& profileOfType(std::string_view type) noexcept {
    for (const DriveProfile& profile : Profiles) {
        if (profile.typePrefix.empty() || !type.starts_with(profile.typePrefix)) continue;
        const std::string_view rest = type.substr(profile.typePrefix.size());
        const bool wholeWord = profile.name != "ra" || rest.empty() || rest.front() == '-';
        if (wholeWord) return profile;
    }
    return Profiles.back();
}

bool takesCycle(const DriveProfile& profile, core::Duration cycle) noexcept {
    if (!profile.cycles.empty()) {
        return std::find(profile.cycles.begin(), profile.cycles.end(), cycle) !=
               profile.cycles.end();
    }
    const bool onStep =
        profile.cycleStep.count() == 0 || cycle.count() % profile.cycleStep.count() == 0;
    return onStep && (profile.longestCycle.count() == 0 || cycle <= profile.longestCycle);
}

bool takesHomingMethod(const DriveProfile& profile, std::int64_t method) noexcept {
    return std::any_of(profile.homingMethods.begin(), profile.homingMethods.end(),
                       [method](std::int8_t known) { return known == method; });
}

}  // namespace takt::config
