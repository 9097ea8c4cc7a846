#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <takt/core/process_image.hpp>
#include <takt/twin/drive_traits.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

#include "object_dictionary.hpp"

namespace takt::twin {

enum class PdoDirection : std::uint8_t { ToDevice, FromDevice };

/// PDO assignment (1C12h, 1C13h) and mapping (16xxh, 1Axxh) of a device: the rules for changing
/// them over CoE (ETG.1000.6 clause 5.6.7.4.7), and the copying between dictionary and process
/// data.
class PdoConfiguration {
public:
    PdoConfiguration(const wire::DeviceDescription& device, const DriveTraits& traits,
                     ObjectDictionary& dictionary);

    /// rt. Whether the object is part of the PDO configuration.
    [[nodiscard]] static bool governs(std::uint16_t index) noexcept;
    /// rt. Writes `value` if the rules allow it. \return 0 or an SDO abort code
    std::uint32_t write(std::uint16_t index, std::uint8_t subindex, std::uint32_t value,
                        bool inPreOp) noexcept;

    /// rt. Works out which objects are exchanged from assignment and mapping.
    /// \return false when an assigned PDO or a mapped object does not exist
    bool resolve(PdoDirection direction) noexcept;
    /// rt. Length of the process data after `resolve`, in bytes.
    [[nodiscard]] std::size_t size(PdoDirection direction) const noexcept;
    /// rt. From the master's bytes into the dictionary. \pre data.size() >= size(ToDevice)
    void takeOutputs(std::span<const std::uint8_t> data) noexcept;
    /// rt. From the dictionary into the bytes for the master. \pre data.size() >= size(FromDevice)
    void putInputs(std::span<std::uint8_t> data) const noexcept;

private:
    struct Mapped {
        core::PdoSlot slot;
        ObjectRef object;
        std::uint32_t wholeBytes{0};  ///< what can be copied as it is; 0: bit by bit
    };
    struct Direction {
        std::vector<Mapped> entries;  ///< capacity reserved at construction
        std::size_t bits{0};
    };

    void addPdo(const wire::PdoDescription& pdo, bool toDevice);
    void addAssignment(std::uint16_t index, const std::vector<wire::PdoDescription>& pdos);
    [[nodiscard]] std::uint32_t number(std::uint16_t index, std::uint8_t subindex) const noexcept;
    void store(std::uint16_t index, std::uint8_t subindex, std::uint32_t value) noexcept;
    std::uint32_t checkAssignment(std::uint16_t index, std::uint8_t subindex,
                                  std::uint32_t value) const noexcept;
    std::uint32_t checkMapping(std::uint16_t index, std::uint8_t subindex,
                               std::uint32_t value) const noexcept;
    bool append(Direction& list, std::uint32_t mapping) noexcept;
    Direction& of(PdoDirection direction) noexcept {
        return lists_[direction == PdoDirection::ToDevice ? 0 : 1];
    }
    const Direction& of(PdoDirection direction) const noexcept {
        return lists_[direction == PdoDirection::ToDevice ? 0 : 1];
    }

    const DriveTraits& traits_;
    ObjectDictionary& dictionary_;
    std::vector<std::uint16_t> fixed_;  ///< PDOs whose mapping must not change
    std::array<Direction, 2> lists_;
};

}  // namespace takt::twin
