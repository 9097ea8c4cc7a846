#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <takt/axis/group_command.hpp>
#include <takt/axis/group_view.hpp>
#include <takt/core/fixed_vector.hpp>
#include <takt/core/job_slot.hpp>
#include <takt/core/time.hpp>
#include <takt/planner/path_planner.hpp>
#include <utility>
#include <vector>

namespace takt::axis {

/// Plans a group's path outside the cycle: the cycle leaves an order, somebody calls work(), the
/// cycle takes the plan at a fixed number of cycles later.
///
///     order = planner.order(); …fill in…; planner.ask();      // the cycle
///     if (planner.wanted()) planner.work();                   // outside
///     if (planner.finished()) { …planner.plan()…; planner.take(); }   // the cycle
class GroupPlanner {
public:
    static constexpr std::size_t MaxElements = 32;  ///< of a window

    /// A motion to be planned; its number is that by which the group knows it.
    struct Item {
        GroupCommand command;
        std::uint32_t serial{0};
    };
    struct Order {
        std::array<const AxisTraits*, MaxGroupAxes> members{};
        std::size_t axes{0};
        const planner::PathMotion* running{nullptr};  ///< null: from rest at `start`
        std::uint64_t from{0};                        ///< state of `running` to go on from
        GroupPoint start{};  ///< where the first item begins: at rest, or at the end of `running`
        core::FixedVector<Item, MaxElements> items{};
    };
    struct Plan {
        const planner::PathMotion* motion{nullptr};  ///< null: there is nothing to move
        std::size_t items{0};                        ///< of the order, from the first, are in it
        GroupPoint end{};
        ErrorId error{ErrorId::None};  ///< of the item behind the last
    };

    explicit GroupPlanner(core::Duration cycle);

    // The cycle's side (rt).
    [[nodiscard]] bool free() const noexcept { return slot_.free(); }
    [[nodiscard]] bool finished() const noexcept { return slot_.done(); }
    /// \pre free()
    [[nodiscard]] Order& order() noexcept { return order_; }
    void ask() noexcept {
        called_ = true;
        slot_.want();
    }
    /// Something has been asked for since the last call.
    [[nodiscard]] bool takeCall() noexcept { return std::exchange(called_, false); }
    /// \pre finished()
    [[nodiscard]] const Plan& plan() const noexcept { return plan_; }
    /// The plan's motion is run from now on; the one before it will be written over.
    void take() noexcept;
    /// The plan is not wanted any more.
    void discard() noexcept { slot_.release(); }

    // The other side.
    [[nodiscard]] bool wanted() const noexcept { return slot_.wanted(); }
    /// Takes milliseconds and allocates. \pre wanted()
    void work();

private:
    void makePlanner();
    [[nodiscard]] bool addElement(Item& item, GroupPoint& from);
    void makePlan(const GroupPoint& end);
    [[nodiscard]] core::Result<std::uint64_t, planner::PathError> planElements();

    core::Duration cycle_;
    core::JobSlot slot_;
    bool called_{false};
    Order order_{};
    Plan plan_{};
    // Of the side that computes.
    std::array<const AxisTraits*, MaxGroupAxes> members_{};
    std::size_t axes_{0};
    std::optional<planner::PathPlanner> planner_;
    std::vector<planner::PathElement> elements_;
    planner::Transition joint_{};  ///< from `running` to the first element
    core::Velocity velocity_{};    ///< of the element before
    // One runs, one is planned.
    std::array<std::optional<planner::PathMotion>, 2> motions_;
    std::size_t spare_{0};
};

}  // namespace takt::axis
