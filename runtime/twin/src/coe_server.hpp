#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <takt/twin/drive_traits.hpp>
#include <takt/wire/al_state.hpp>

#include "object_dictionary.hpp"
#include "pdo_configuration.hpp"

namespace takt::twin {

/// The SDO server of a device (ETG.1000.6 clause 5.6.2): expedited, normal and segmented transfers.
/// Complete access is for downloads that one message holds, and for devices that offer it; all
/// other is refused, which masters must take for an answer.
class CoeServer {
public:
    CoeServer(const DriveTraits& traits, ObjectDictionary& dictionary, PdoConfiguration& pdos,
              bool completeAccess)
        : traits_{traits}, dictionary_{dictionary}, pdos_{pdos}, completeAccess_{completeAccess} {}

    /// rt. Answers one SDO request. `request` and `reply` begin behind the CoE header.
    /// \return bytes of the reply; 0 = no reply
    /// \pre request.size() >= 8, reply.size() >= 8
    std::size_t answer(std::span<const std::uint8_t> request, std::span<std::uint8_t> reply,
                       wire::AlState state) noexcept;

    /// rt. Writes an object as an SDO download does. \return 0 or an abort code
    std::uint32_t download(std::uint16_t index, std::uint8_t subindex,
                           std::span<const std::uint8_t> data, wire::AlState state) noexcept;

    /// rt. The same for all sub-indices from `first` (0 or 1) on, packed as ETG.1000.6 5.6.2.5 has
    /// it: sub-index 0 with a byte behind it, then the others by bytes.
    std::uint32_t downloadWhole(std::uint16_t index, std::uint8_t first,
                                std::span<const std::uint8_t> data, wire::AlState state) noexcept;

private:
    static constexpr std::size_t LargestTransfer = 1024;

    enum class Transfer : std::uint8_t { None, Download, Upload };

    std::size_t startDownload(std::span<const std::uint8_t> request, std::span<std::uint8_t> reply,
                              wire::AlState state) noexcept;
    std::size_t continueDownload(std::span<const std::uint8_t> request,
                                 std::span<std::uint8_t> reply, wire::AlState state) noexcept;
    std::size_t startUpload(std::span<const std::uint8_t> request,
                            std::span<std::uint8_t> reply) noexcept;
    std::size_t continueUpload(std::span<const std::uint8_t> request,
                               std::span<std::uint8_t> reply) noexcept;
    std::size_t abortTransfer(std::span<std::uint8_t> reply, std::uint16_t index,
                              std::uint8_t subindex, std::uint32_t code) noexcept;
    [[nodiscard]] std::uint32_t absence(std::uint16_t index) const noexcept;
    [[nodiscard]] std::uint32_t checkValue(const DictionaryEntry& entry,
                                           std::span<const std::uint8_t> data) const noexcept;

    const DriveTraits& traits_;
    ObjectDictionary& dictionary_;
    PdoConfiguration& pdos_;
    bool completeAccess_;

    Transfer transfer_{Transfer::None};
    std::uint16_t index_{0};
    std::uint8_t subindex_{0};
    std::uint8_t toggle_{0};
    std::size_t done_{0};
    std::size_t size_{0};
    std::array<std::uint8_t, LargestTransfer> buffer_{};
};

}  // namespace takt::twin
