#pragma once

#include <optional>
#include <span>
#include <takt/config/machine_config.hpp>
#include <takt/core/fixed_vector.hpp>
#include <takt/fieldbus/ethercat/master.hpp>
#include <vector>

#include "axes.hpp"
#include "control_command.hpp"
#include "program_host.hpp"

namespace takt::daemon {

/// Objects of devices, read and written for people while the machine runs: one request after the
/// other, as acyclic work of the master.
///
/// Reading is open at any time. A device is not written while a program runs or its axis moves,
/// unless forced; what travels with the process data is never written.
class BusDesk {
public:
    static constexpr std::size_t MostWaiting = 16;

    struct Parts {
        const fieldbus::NetworkParams& network;
        const std::vector<axis::AxisParams>& axisParams;
        fieldbus::ethercat::Master& master;
        const Axes& axes;
        std::span<const ProgramHost> programs;
    };
    explicit BusDesk(const Parts& parts);

    /// rt. Takes an Upload or Download. \param operating motion may be asked for
    [[nodiscard]] Verdict begin(const ControlCommand& command, bool operating) noexcept;
    /// rt. One cycle. \return what there is to answer
    [[nodiscard]] std::optional<ControlAnswer> cycle(core::CycleNumber cycle) noexcept;

private:
    [[nodiscard]] Verdict judgeWrite(const ControlCommand& command, bool operating) const noexcept;
    [[nodiscard]] bool start(const ControlCommand& command) noexcept;

    Parts parts_;
    std::vector<std::size_t> deviceOfAxis_;
    core::FixedVector<ControlCommand, MostWaiting> waiting_;  ///< the first is under way, or next
    bool underWay_{false};
    bool resting_{false};  ///< one cycle after each request, so that an axis gets its turn
};

}  // namespace takt::daemon
