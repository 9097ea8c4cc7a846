#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <takt/axis/error.hpp>
#include <takt/axis/path_data.hpp>
#include <takt/core/job_slot.hpp>
#include <takt/core/time.hpp>

namespace takt::axis {

struct AxisTraits;

/// Where a program asks for a way of a group around its keep-outs. Whoever knows the keep-outs
/// answers outside the cycle; the program sees the answer a fixed number of cycles after its order,
/// so that a simulated run does not depend on how fast the computer is. On a machine it may come
/// later: nothing waits for it but the program.
///
///     ticket = desk.ask(order, cycle);                        // the program
///     if (desk.wanted()) { …desk.order()…; desk.finish(answer); }     // outside
///     if (const auto* answer = desk.answer(ticket, cycle)) …  // the program, later
class RouteDesk {
public:
    struct Order {
        std::array<const AxisTraits*, MaxGroupAxes> members{};  ///< of the group when it was asked
        GroupPoint start{};
        GroupPoint goal{};
        double rounding{0.0};
        std::uint64_t seed{1};
    };
    struct Answer {
        ErrorId error{ErrorId::None};
        std::uint32_t keepOut{0};  ///< that start or goal lies in, from 1; 0 = none
        double duration{0.0};      ///< s; of the path at the limits of group and axes
        PathData path{};
    };
    enum class Ticket : std::uint32_t { None = 0 };

    // Before the first cycle.

    /// \param cycles from an order to its answer; 0 = there is nobody to answer
    void serve(std::uint32_t cycles) noexcept { latency_ = cycles; }

    // The program's side (rt).

    [[nodiscard]] bool served() const noexcept { return latency_ > 0; }
    /// An answer that its owner has not taken yet is thrown away.
    /// \return None while another order is being worked on
    [[nodiscard]] Ticket ask(const Order& order, core::CycleNumber now) noexcept {
        if (slot_.wanted()) return Ticket::None;
        if (slot_.done()) slot_.release();
        order_ = order;
        due_ = now + latency_;
        ticket_ = static_cast<Ticket>(static_cast<std::uint32_t>(ticket_) + 1);
        if (ticket_ == Ticket::None) ticket_ = Ticket{1};
        called_.store(true, std::memory_order_relaxed);
        slot_.want();
        return ticket_;
    }
    /// The order is still the one of the desk.
    [[nodiscard]] bool owns(Ticket ticket) const noexcept { return ticket == ticket_; }
    /// Null until the answer is there. \pre owns(ticket)
    [[nodiscard]] const Answer* answer(core::CycleNumber now) const noexcept {
        return slot_.done() && now >= due_ ? &answer_ : nullptr;
    }

    // The cycle's side (rt).

    /// Something has been asked for since the last call.
    [[nodiscard]] bool takeCall() noexcept {
        return called_.load(std::memory_order_relaxed) &&
               called_.exchange(false, std::memory_order_relaxed);
    }

    // The side that answers.

    [[nodiscard]] bool wanted() const noexcept { return slot_.wanted(); }
    /// \pre wanted()
    [[nodiscard]] const Order& order() const noexcept { return order_; }
    /// \pre wanted()
    void finish(const Answer& answer) noexcept {
        answer_ = answer;
        slot_.finish();
    }

private:
    std::uint32_t latency_{0};
    core::JobSlot slot_;
    std::atomic<bool> called_{false};
    Order order_{};
    Answer answer_{};
    core::CycleNumber due_{0};
    Ticket ticket_{Ticket::None};
};

}  // namespace takt::axis
