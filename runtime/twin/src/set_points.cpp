#include "set_points.hpp"

namespace takt::twin {

void SetPoints::clear(std::int64_t position, bool bit4) noexcept {
    active_.reset();
    waiting_.reset();
    lastTarget_ = position;
    lastBit_ = bit4;
    acknowledged_ = false;
}

bool SetPoints::request(bool bit4) noexcept {
    const bool rising = bit4 && !lastBit_;
    lastBit_ = bit4;
    // The acknowledgement falls when the master has seen it and there is room for another one.
    if (!bit4 && !waiting_) acknowledged_ = false;
    return rising;
}

bool SetPoints::take(const SetPoint& next, bool immediately) noexcept {
    if (!immediately && waiting_) return false;  // full: the acknowledgement stands, nothing taken
    acknowledged_ = true;
    lastTarget_ = next.target;
    if (immediately || !active_) {
        active_ = next;
        active_->goOn = false;
        waiting_.reset();
        return true;
    }
    waiting_ = next;
    return next.goOn;
}

bool SetPoints::finish() noexcept {
    active_ = waiting_;
    waiting_.reset();
    return active_.has_value();
}

}  // namespace takt::twin
