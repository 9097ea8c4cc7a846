#pragma once

#include <cstdint>
#include <takt/core/process_image.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>

namespace takt::fieldbus {

/// Seen from the master: outputs go to the device, inputs come from it.
enum class Direction : std::uint8_t { Outputs, Inputs };

/// Where an entry lies inside the device's own output or input bytes: PDOs in assignment order,
/// entries in mapping order, bit-packed without alignment (ETG.1000.6 clause 5.6.7.4). The first
/// match counts. \return a slot that is not `present()` when the entry is not mapped or is wider
/// than 32 bits
[[nodiscard]] core::PdoSlot findEntry(const SlaveParams& slave, Direction direction,
                                      std::uint16_t index, std::uint8_t subindex) noexcept;

/// Bytes of process data in one direction: the mapped bits rounded up; the SyncManager's length.
/// The image of the device has one more where a shift makes the data straddle a byte.
[[nodiscard]] std::uint32_t processDataBytes(const SlaveParams& slave,
                                             Direction direction) noexcept;

}  // namespace takt::fieldbus
