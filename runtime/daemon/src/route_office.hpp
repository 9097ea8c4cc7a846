#pragma once

#include <cstddef>
#include <takt/axis/route_desk.hpp>
#include <takt/config/machine_config.hpp>
#include <takt/planner/path_planner.hpp>
#include <takt/planner/roadmap/obstacles.hpp>
#include <takt/planner/roadmap/route.hpp>
#include <vector>

#include "axes.hpp"
#include "program_host.hpp"

namespace takt::daemon {

/// Answers what programs ask for at their route desks: it knows the keep-outs of every group.
class RouteOffice {
public:
    /// All must outlive the object.
    RouteOffice(const config::MachineConfig& machine, const Axes& axes,
                std::vector<ProgramHost>& programs);

    /// rt. Somebody has asked since the last call.
    [[nodiscard]] bool takeCalls() noexcept;
    /// Plans all that is wanted. Takes milliseconds for each and allocates.
    void work();

private:
    /// The axes of a group and what they go around.
    struct Ground {
        planner::roadmap::Obstacles obstacles;
        std::vector<const axis::AxisTraits*> members;
        std::vector<planner::roadmap::RouteAxis> axes;
        std::vector<planner::PathAxisLimits> limits;
        planner::PathFeed feed;
    };
    struct Post {
        axis::RouteDesk* desk;
        std::size_t ground;
    };

    [[nodiscard]] static Ground groundOf(const planner::roadmap::ObstacleParams& params,
                                         const axis::GroupParams& group, const Axes& axes);
    [[nodiscard]] axis::RouteDesk::Answer answer(const Ground& ground,
                                                 const axis::RouteDesk::Order& order) const;
    [[nodiscard]] axis::RouteDesk::Answer plan(const Ground& ground,
                                               const axis::RouteDesk::Order& order) const;

    core::Seconds cycle_;
    std::vector<Ground> grounds_;
    std::vector<Post> posts_;
};

}  // namespace takt::daemon
