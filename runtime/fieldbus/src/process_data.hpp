#pragma once

#include <cstdint>
#include <span>
#include <takt/core/process_image.hpp>
#include <takt/fieldbus/ethercat/cycle_counters.hpp>
#include <vector>

#include "cycle_plan.hpp"
#include "frame_set.hpp"

namespace takt::fieldbus::ethercat {

/// The process image of all slaves and its way into and out of the frames. Inputs are taken only
/// from a datagram whose working counter is exactly the expected one.
class ProcessData {
public:
    /// `plan` must outlive this object.
    explicit ProcessData(const CyclePlan& plan);

    /// rt. No datagram is sent any more until it is appended again.
    void forgetDatagrams() noexcept;
    /// rt. Appends a datagram of the plan to the open frame. \pre it carries process data
    void append(FrameSet& frames, std::size_t datagram) noexcept;
    /// rt. Copies all outputs into their datagrams.
    void fill(FrameSet& frames) noexcept;
    /// rt. Takes the replies of all groups. While `supervised` is false a wrong working counter is
    /// normal.
    void take(const FrameSet& frames, bool supervised) noexcept;

    /// rt. All groups came back with the right working counter in the last cycle.
    [[nodiscard]] bool allGood() const noexcept { return allGood_; }
    /// rt. Some datagram came back with a wrong one in the last cycle.
    [[nodiscard]] bool wrongCounter() const noexcept { return wrongCounter_; }
    [[nodiscard]] core::DeviceImage image(std::size_t slave) noexcept;
    /// rt.
    void setOperational(std::size_t slave, bool operational, std::uint16_t alCode) noexcept;
    [[nodiscard]] const core::DeviceHealth& health(std::size_t slave) const noexcept {
        return health_[slave];
    }
    [[nodiscard]] std::span<const GroupCounters> groups() const noexcept { return counters_; }
    /// Zeros all outputs and inputs, and all that is known of the slaves' health.
    void reset() noexcept;

private:
    struct Place {
        DatagramId id{0};
        bool sent{false};
    };
    enum class Outcome : std::uint8_t { NotSent, Lost, Wrong, Right };

    [[nodiscard]] Outcome judge(const FrameSet& frames, std::size_t group) noexcept;
    void takeInputs(const FrameSet& frames, std::size_t group) noexcept;
    void markSlaves() noexcept;

    const CyclePlan& plan_;
    std::vector<Place> places_;  ///< one for each datagram of the plan
    std::vector<std::uint8_t> good_;
    std::vector<std::uint8_t> outputs_;
    std::vector<std::uint8_t> inputs_;
    std::vector<core::DeviceHealth> health_;
    std::vector<GroupCounters> counters_;
    bool allGood_{false};
    bool wrongCounter_{false};
};

}  // namespace takt::fieldbus::ethercat
