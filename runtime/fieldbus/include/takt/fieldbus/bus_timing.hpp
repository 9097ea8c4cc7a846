#pragma once

#include <cstddef>
#include <takt/core/time.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>

namespace takt::fieldbus {

/// What one bus cycle costs at 100 Mbit/s, with the acyclic slice full.
struct BusTiming {
    std::size_t frameBytes{0};  ///< of all frames of a cycle, without preamble, FCS and gap
    std::size_t frames{0};
    std::size_t acyclicBytes{0};  ///< the share of `frameBytes` kept for the acyclic slice
    core::Duration wireTime{0};   ///< 80 ns for every byte, preamble, FCS and gap included
    core::Duration roundTrip{0};  ///< wire time and the way through all devices and back
    core::Duration receiveDeadline{
        0};  ///< after the send: max(30 % of T, wire + send jitter + 50 µs)
    core::Duration sync0AfterSend{
        0};            ///< max(25 % of T, wire to the last device + send jitter + copy)
    double load{0.0};  ///< share of the cycle that is needed; above 0.8 is refused
};

/// Bytes that the acyclic slice may put into one cycle: the largest mailbox, or an AL status read
/// of every device, whichever is more; at most one full frame.
[[nodiscard]] std::size_t acyclicSliceBytes(const NetworkParams& network) noexcept;

[[nodiscard]] BusTiming computeTiming(const NetworkParams& network);

}  // namespace takt::fieldbus
