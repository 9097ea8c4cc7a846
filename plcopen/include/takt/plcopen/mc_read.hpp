#pragma once

#include <cstdint>
#include <takt/axis/axis_port.hpp>
#include <takt/axis/error.hpp>

namespace takt::plcopen {

/// What every Enable-type read block has in common: Valid, Busy and Error by level, everything
/// FALSE or 0 in the call in which Enable falls.
class ReadBlock {
public:
    ReadBlock(const ReadBlock&) = delete;
    ReadBlock& operator=(const ReadBlock&) = delete;

    bool Enable{false};

    bool Valid{false};  ///< the data outputs are trustworthy
    bool Busy{false};
    bool Error{false};
    axis::ErrorId ErrorID{axis::ErrorId::None};

protected:
    ReadBlock() = default;
    ~ReadBlock() = default;

    /// rt. Sets the common outputs. `ready(view)` is false while what is to be read will be there
    /// again later. \return the view to read from, null when there is nothing to show
    template <typename Ref, typename Ready>
    auto read(const Ref& ref, Ready&& ready) noexcept -> decltype(&ref.port().view()) {
        if (!begin(ref.valid())) return nullptr;
        const auto& view = ref.port().view();
        if (view.traits == nullptr || !ready(view)) return nullptr;
        Valid = true;
        return &view;
    }
    /// rt. What was asked for does not exist: an error until Enable rises again.
    void refuse(axis::ErrorId error) noexcept;

private:
    [[nodiscard]] bool begin(bool valid) noexcept;

    axis::ErrorId refused_{axis::ErrorId::None};  ///< stays an error until Enable rises again
};

/// Exactly one state output is TRUE while Valid.
class MC_ReadStatus : public ReadBlock {
public:
    bool ErrorStop{false};
    bool Disabled{false};
    bool Stopping{false};
    bool Homing{false};
    bool Standstill{false};
    bool DiscreteMotion{false};
    bool ContinuousMotion{false};
    bool SynchronizedMotion{false};

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

/// Actual position of this cycle, folded on a modulo axis.
class MC_ReadActualPosition : public ReadBlock {
public:
    double Position{0.0};  ///< u

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

/// Why the axis is in ErrorStop. The common output ErrorID is this error; `Error` speaks of the
/// block alone.
class MC_ReadAxisError : public ReadBlock {
public:
    std::uint16_t AxisErrorID{0};  ///< the drive's error code (603Fh)

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

}  // namespace takt::plcopen
