#pragma once

#include <cstdint>
#include <takt/scheduler/scheduler_params.hpp>

namespace takt::scheduler {

/// In ascending severity.
enum class OverrunVerdict : std::uint8_t { Fine, StopOnPath, DriveStop };

/// Counts missed cycles and says when there were too many (fault F31).
class OverrunGuard {
public:
    explicit OverrunGuard(const OverrunParams& params) noexcept : params_{params} {}

    /// rt. \param skipped grid points that had passed unused before this cycle
    OverrunVerdict update(std::uint32_t skipped) noexcept;

    [[nodiscard]] std::uint64_t overruns() const noexcept { return overruns_; }  ///< late cycles
    [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }    ///< grid points
    [[nodiscard]] std::uint32_t inRow() const noexcept { return inRow_; }

private:
    static constexpr std::uint32_t RateWindow = 1000;  ///< cycles

    [[nodiscard]] bool tooMany(std::uint32_t skipped) noexcept;

    OverrunParams params_;
    std::uint64_t overruns_{0};
    std::uint64_t skipped_{0};
    std::uint32_t inRow_{0};
    std::uint32_t windowCycles_{0};
    std::uint32_t windowSkipped_{0};
};

}  // namespace takt::scheduler
