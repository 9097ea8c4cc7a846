#pragma once

#include <cstdint>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::twin {

/// The EEPROM image (ETG.1000.6 clause 5.4, ETG.2010) of a device as its description tells it:
/// configuration area with checksum, identity, mailbox words, and the categories strings, general,
/// FMMU, SyncManager, TxPDO, RxPDO and DC.
[[nodiscard]] std::vector<std::uint8_t> buildSiiImage(const wire::DeviceDescription& device);

/// The checksum of the configuration area: CRC-8, polynomial x^8+x^2+x+1, start 0xFF. \pre 14 bytes
[[nodiscard]] std::uint8_t siiChecksum(const std::vector<std::uint8_t>& image);

/// Number of the CoE base data type an ESI entry type name stands for ("UINT" → 6); 0 when unknown.
[[nodiscard]] std::uint8_t coeTypeOf(const std::string& esiType);

}  // namespace takt::twin
