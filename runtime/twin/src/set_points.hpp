#pragma once

#include <cstdint>
#include <optional>

#include "motion_generator.hpp"

namespace takt::twin {

/// One set-point of Profile position: where to, and the profile that was valid when it was given.
struct SetPoint {
    std::int64_t target{0};  ///< user counts, unwrapped
    MotionLimits limits;     ///< turns and seconds
    bool goOn{false};        ///< the set-point before it is passed at speed (controlword bit 9)
};

/// The set-points of Profile position (IEC 61800-7-201, clause 10): one in work, one waiting, and
/// the acknowledgement in statusword bit 12.
class SetPoints {
public:
    /// rt. Forgets everything; the next move starts from `position` (user counts). `bit4`: what
    /// the controlword shows and what therefore is no new set-point.
    void clear(std::int64_t position, bool bit4) noexcept;
    /// rt. Follows controlword bit 4. \return a new set-point may be taken in this cycle
    bool request(bool bit4) noexcept;
    /// rt. Takes one over. \return the motion changes: `active` is to be started, or passed at
    /// speed
    bool take(const SetPoint& next, bool immediately) noexcept;
    /// rt. The one in work is done. \return another one has come into work
    bool finish() noexcept;

    [[nodiscard]] const std::optional<SetPoint>& active() const noexcept { return active_; }
    [[nodiscard]] const std::optional<SetPoint>& waiting() const noexcept { return waiting_; }
    [[nodiscard]] bool acknowledged() const noexcept { return acknowledged_; }
    /// What a relative set-point is added to: the last target that was taken.
    [[nodiscard]] std::int64_t lastTarget() const noexcept { return lastTarget_; }

private:
    std::optional<SetPoint> active_;
    std::optional<SetPoint> waiting_;
    std::int64_t lastTarget_{0};
    bool lastBit_{false};
    bool acknowledged_{false};
};

}  // namespace takt::twin
