#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include <takt/axis/axis.hpp>
#include <takt/core/spsc_ring.hpp>
#include <takt/core/time.hpp>

#include "axes.hpp"

namespace takt::daemon {

/// Something a person should know, as it leaves the cycle: numbers only. RunReporter finds the words.
struct RunNotice {
    enum class Kind : std::uint8_t {
        ReachedOp,        ///< `time`: since the first cycle
        NetworkFailed,    ///< while going to OP
        OpTimedOut,
        ProgramEnded,     ///< `index`: of the program
        AxisNotStopped,   ///< `index`: of the axis
        InitTimedOut,
        CycleMissed,      ///< the first one; `number`: grid points
        StoppedOnPath,    ///< too many missed cycles; `number`: in a row
        DrivesStopped,
    };
    Kind kind{Kind::ReachedOp};
    std::size_t index{0};
    core::CycleNumber cycle{0};
    core::Duration time{0};
    std::uint64_t number{0};
};

/// From the cycle to whoever prints.
using RunNotices = core::SpscRing<RunNotice>;

/// Where the axes are, for the progress line: written by the cycle, read by anybody. Each value is whole;
/// values of different axes may be of neighbouring cycles.
class AxisLights {
public:
    explicit AxisLights(std::size_t axes) : lights_(axes) {}

    /// rt.
    void update(core::CycleNumber cycle, const Axes& axes) noexcept {
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            lights_[i].actual.store(axes[i].view().actual.count(), std::memory_order_relaxed);
            lights_[i].state.store(axes[i].state(), std::memory_order_relaxed);
        }
        cycle_.store(cycle, std::memory_order_relaxed);
    }
    [[nodiscard]] core::CycleNumber cycle() const noexcept { return cycle_.load(std::memory_order_relaxed); }
    [[nodiscard]] double actual(std::size_t axis) const noexcept {
        return lights_[axis].actual.load(std::memory_order_relaxed);
    }
    [[nodiscard]] axis::AxisState state(std::size_t axis) const noexcept {
        return lights_[axis].state.load(std::memory_order_relaxed);
    }

private:
    struct Light {
        std::atomic<double> actual{0.0};
        std::atomic<axis::AxisState> state{axis::AxisState::Disabled};
    };
    std::vector<Light> lights_;
    std::atomic<core::CycleNumber> cycle_{0};
};

}  // namespace takt::daemon
