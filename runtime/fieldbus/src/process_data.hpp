#pragma once

#include <cstdint>
#include <span>
#include <takt/core/process_image.hpp>
#include <takt/fieldbus/ethercat/cycle_counters.hpp>
#include <vector>

#include "frame_set.hpp"
#include "logical_layout.hpp"

namespace takt::fieldbus::ethercat {

/// The process image of all slaves and its way into and out of the frames. Inputs are taken only
/// from a datagram whose working counter is exactly the expected one.
class ProcessData {
public:
    /// `layout` must outlive this object.
    explicit ProcessData(const LogicalLayout& layout);

    /// Appends the datagrams of one group to the open frame.
    void append(FrameSet& frames, std::size_t group) noexcept;
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
    struct Buffers {
        std::size_t outputs{0};  ///< offset of the group's outputs in outputs_
        std::size_t inputs{0};
        DatagramId first{0};   ///< LRW, or LWR
        DatagramId second{0};  ///< LRD
        bool good{false};
    };
    struct Outcome {
        bool arrived{false};
        bool right{false};
        std::span<const std::uint8_t> inputs{};
    };

    [[nodiscard]] Outcome judge(const FrameSet& frames, std::size_t group) noexcept;
    void markGood(std::size_t group) noexcept;
    void markBad(std::size_t group) noexcept;

    const LogicalLayout& layout_;
    std::vector<Buffers> buffers_;
    std::vector<std::uint8_t> outputs_;
    std::vector<std::uint8_t> inputs_;
    std::vector<core::DeviceHealth> health_;
    std::vector<GroupCounters> counters_;
    bool allGood_{false};
    bool wrongCounter_{false};
};

}  // namespace takt::fieldbus::ethercat
