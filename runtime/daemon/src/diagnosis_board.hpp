#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <takt/core/seq_lock.hpp>
#include <takt/fieldbus/ethercat/master.hpp>

#include "cycle_statistics.hpp"

namespace takt::daemon {

/// What the cycle knows of its own timing and of the network as a whole.
struct DiagnosisEntry {
    core::CycleNumber cycle{0};
    CycleStatistics statistics{};
    std::uint64_t lateWakeUps{0};
    std::uint64_t missedCycles{0};
    std::uint32_t relocks{0};
    bool clockLocked{false};
    double driftPpm{0.0};
    fieldbus::ethercat::NetworkState network{};
    fieldbus::ethercat::NetworkProblem problem{};
    fieldbus::ethercat::CycleCounters counters{};
};

/// What the master knows of one device.
struct DeviceEntry {
    fieldbus::ethercat::DeviceState state{};
    std::uint16_t group{0};
    fieldbus::ethercat::GroupCounters counters{};
    std::uint32_t lostInRow{0};
    std::uint32_t emergencies{0};
    std::uint16_t lastEmergency{0};
};

/// rt.
[[nodiscard]] DeviceEntry entryOf(fieldbus::ethercat::Master& master, std::size_t device) noexcept;

/// The diagnosis, written by the cycle only when somebody has asked for it, since it is long: a few
/// devices in each cycle.
///
///     const auto number = board.ask();                   // anybody, outside the cycle
///     if (board.wanted()) board.show(entry, master);     // the cycle
///     if (board.shown(number)) … board.run.read() …
class DiagnosisBoard {
public:
    static constexpr std::size_t MostPerCycle = 16;

    explicit DiagnosisBoard(std::size_t deviceCount) : devices(deviceCount) {}

    /// \return what to wait for
    std::uint32_t ask() noexcept { return asked_.fetch_add(1, std::memory_order_relaxed) + 1; }
    [[nodiscard]] bool shown(std::uint32_t number) const noexcept {
        return static_cast<std::int32_t>(shown_.load(std::memory_order_acquire) - number) >= 0;
    }
    /// rt.
    [[nodiscard]] bool wanted() const noexcept {
        return asked_.load(std::memory_order_relaxed) != shown_.load(std::memory_order_relaxed);
    }
    /// rt. The next part. \pre wanted()
    void show(const DiagnosisEntry& entry, fieldbus::ethercat::Master& master) noexcept;

    core::SeqLock<DiagnosisEntry> run;
    std::deque<core::SeqLock<DeviceEntry>> devices;

private:
    std::atomic<std::uint32_t> asked_{0};
    std::atomic<std::uint32_t> shown_{0};
    std::uint32_t showing_{0};  ///< the request that is being answered
    std::size_t next_{0};
};

}  // namespace takt::daemon
