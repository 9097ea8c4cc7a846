#pragma once

#include <cstddef>
#include <takt/planner/trajectory.hpp>
#include <vector>

namespace takt::planner::bench {

/// The same requests on every machine: `count` times `axes` random third-order moves with ordinary
/// limits.
class Workload {
public:
    Workload(std::size_t axes, std::size_t count);

    [[nodiscard]] std::size_t size() const noexcept { return requests_.size() / axes_; }
    /// \return the duration, so that the work is not removed
    double plan(std::size_t i, Trajectory& trajectory) const;
    [[nodiscard]] std::size_t axes() const noexcept { return axes_; }

private:
    std::size_t axes_;
    std::vector<AxisRequest> requests_;
};

}  // namespace takt::planner::bench
