#pragma once

#include <optional>
#include <takt/axis/axis.hpp>
#include <takt/axis/axis_port.hpp>
#include <takt/plcopen/plcopen.hpp>

#include "control_command.hpp"

namespace takt::daemon {

/// Where the operator stands at one axis: the same blocks a program uses, driven by single
/// commands.
///
///     if (station.begin(command)) … else busy
///     each cycle: if (auto answer = station.cycle(axis)) …
///
/// Only one command runs at a time. A motion goes on only while the operator gives signs of life;
/// letGo() ends it.
class AxisStation {
public:
    AxisStation() : ref_{port_} {}
    AxisStation(const AxisStation&) = delete;
    AxisStation& operator=(const AxisStation&) = delete;

    /// rt. Starts the command with the next cycle(). \return false when another one still runs;
    /// switching off takes its place instead
    [[nodiscard]] bool begin(const ControlCommand& command) noexcept;
    /// rt. One cycle of the blocks. \return what there is to answer, with its ticket
    [[nodiscard]] std::optional<ControlAnswer> cycle(axis::Axis& axis) noexcept;
    /// rt. Takes the hand from the button: the axis stops on its ramp.
    void letGo() noexcept;
    /// rt. The axis moves for the operator.
    [[nodiscard]] bool moves() const noexcept {
        return running_ && (task_.order == Order::Inch || task_.order == Order::Home);
    }
    /// rt. … and he has not let go of the button.
    [[nodiscard]] bool held() const noexcept {
        return moves() && (inch_.InchForward || inch_.InchBackward || home_.Execute);
    }

private:
    struct Progress {
        bool error{false};
        bool aborted{false};
        bool done{false};
        axis::ErrorId id{axis::ErrorId::None};
    };
    template <typename Block>
    [[nodiscard]] static Progress progressOf(const Block& block) noexcept;
    [[nodiscard]] Progress call() noexcept;
    [[nodiscard]] Progress callPower(bool on) noexcept;
    void prepare(const ControlCommand& command) noexcept;
    void release() noexcept;
    void stopHoming() noexcept;

    static constexpr std::uint16_t PortNumber = 0xFFFF;  ///< programs count from 1

    axis::AxisPort port_{PortNumber};
    axis::AxisRef ref_;
    plcopen::MC_Inch inch_;
    plcopen::MC_Home home_;
    plcopen::MC_Reset reset_;
    plcopen::MC_Stop stop_;
    ControlCommand task_{};
    std::uint64_t superseded_{0};  ///< ticket of a task that made room
    bool running_{false};
    bool fresh_{false};  ///< the first cycle of the task
};

}  // namespace takt::daemon
