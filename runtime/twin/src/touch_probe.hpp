#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace takt::twin {

/// What a probe can be triggered by in one control step; turns of the motor shaft.
struct ProbeSignals {
    std::array<bool, 2> input{};    ///< level of the digital input of each probe
    std::array<double, 2> place{};  ///< where that input changes
    bool indexPassed{false};
    double indexPlace{0.0};
};

/// The two touch probes of a drive: 60B8h arms them, 60B9h to 60BDh show what they caught.
class TouchProbe {
public:
    static constexpr std::size_t Channels = 2;

    /// What was caught on one edge.
    struct Catch {
        bool valid{false};
        double turns{0.0};
        std::uint16_t count{0};
        std::uint32_t time{0};
    };

    /// rt. Follows 60B8h. Enabling arms with the settings of that moment; later changes count from
    /// the next enabling only. `signals`: the present ones, no edges yet.
    void configure(std::uint16_t function, const ProbeSignals& signals) noexcept;
    /// rt. One control step. `time` is stored with what is caught.
    void step(const ProbeSignals& signals, std::uint32_t time) noexcept;

    /// rt. A probe waits for an edge.
    [[nodiscard]] bool armed() const noexcept { return channels_[0].armed || channels_[1].armed; }
    /// rt. 60B9h. `counts`: bits 6, 7, 14 and 15 count what was caught, modulo 4.
    [[nodiscard]] std::uint16_t status(bool counts) const noexcept;
    /// `channel` 0 or 1.
    [[nodiscard]] const Catch& caught(std::size_t channel, bool rising) const noexcept {
        return rising ? channels_[channel].rising : channels_[channel].falling;
    }

private:
    struct Channel {
        bool enabled{false};
        bool armed{false};
        bool continuous{false};
        bool byIndex{false};
        bool wantsRising{false};
        bool wantsFalling{false};
        bool last{false};
        std::uint8_t executions{0};
        Catch rising;
        Catch falling;
    };
    static void take(Catch& edge, Channel& channel, double place, std::uint32_t time) noexcept;

    std::array<Channel, Channels> channels_;
};

}  // namespace takt::twin
