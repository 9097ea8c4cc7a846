#pragma once

#include <cstdint>
#include <takt/core/time.hpp>
#include <takt/twin/drive_traits.hpp>
#include <vector>

#include "drive.hpp"
#include "object_dictionary.hpp"

namespace takt::twin {

/// What happens to a drive's parameters beside being read and written: storing, restoring, restart,
/// pairs of stored and volatile objects, and objects that may not change while the motor is on.
class DriveParameters {
public:
    /// After the dictionary is complete. The delivered values are those it holds now.
    DriveParameters(ObjectDictionary& dictionary, const DriveTraits& traits, Drive& drive);

    /// rt. Abort code with which the drive refuses a value; 0 = takes it.
    [[nodiscard]] std::uint32_t refusal(std::uint16_t index, std::uint8_t subindex,
                                        std::int64_t value) const noexcept;
    /// rt. A value was written over the bus.
    void written(const DictionaryEntry& entry) noexcept;
    /// rt. `elapsed` has passed: storing goes on.
    void pass(core::Duration elapsed) noexcept;

private:
    [[nodiscard]] bool isCommand(std::uint16_t index, std::uint8_t subindex) const noexcept;
    void command(std::uint32_t code) noexcept;
    void restart() noexcept;
    void restore(std::uint16_t first, std::uint16_t last) noexcept;
    void copy(const DictionaryEntry& entry, const std::vector<std::uint8_t>& from) noexcept;

    ObjectDictionary& dictionary_;
    const DriveTraits& traits_;
    Drive& drive_;
    std::vector<std::uint8_t> delivered_;
    std::vector<std::uint8_t> stored_;
    core::Duration storing_{0};
};

}  // namespace takt::twin
