#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::twin {

/// Where an object's value lies in its dictionary.
struct ObjectRef {
    std::uint32_t offset{0};
    std::uint8_t size{1};  ///< bytes, 1 to 8
};

/// One entry (index, sub-index) of a device's object dictionary.
struct DictionaryEntry {
    std::uint16_t index{0};
    std::uint8_t subindex{0};
    wire::DataType type{wire::DataType::Unsigned32};
    std::uint16_t bits{0};
    std::uint32_t offset{0};
    std::uint32_t size{0};  ///< bytes
    bool readable{true};
    bool writable{false};
    bool onlyInPreOp{false};
    bool hidden{false};      ///< the drive needs it, the device's dictionary does not show it
    bool toDevice{false};    ///< may be mapped to an RxPDO
    bool fromDevice{false};  ///< may be mapped to a TxPDO
    std::optional<std::int64_t> minimum;
    std::optional<std::int64_t> maximum;

    [[nodiscard]] bool isSigned() const noexcept;
    /// A simple number of up to eight bytes, so that a length must match exactly.
    [[nodiscard]] bool isNumber() const noexcept;
};

/// The object dictionary of a simulated device: entries from its description, values in one block
/// of memory. Entries are added while the device is put together; afterwards nothing allocates.
class ObjectDictionary {
public:
    explicit ObjectDictionary(const wire::DeviceDescription& device);

    /// rt. A number's place; of longer values the first eight bytes.
    [[nodiscard]] static ObjectRef refOf(const DictionaryEntry& entry) noexcept {
        const std::uint32_t size = entry.size < 1 ? 1 : entry.size > 8 ? 8 : entry.size;
        return {entry.offset, static_cast<std::uint8_t>(size)};
    }

    /// Adds an entry, or leaves the one that the description brought along as it is.
    ObjectRef ensure(const DictionaryEntry& wanted, std::int64_t value);
    /// The same for an object the description may lack: it then works but is not visible to the
    /// master.
    ObjectRef internal(std::uint16_t index, std::uint8_t subindex, wire::DataType type,
                       std::int64_t value);

    /// rt. Null when there is no such visible entry.
    [[nodiscard]] const DictionaryEntry* find(std::uint16_t index,
                                              std::uint8_t subindex) const noexcept;
    /// rt. Whether the object has any visible entry.
    [[nodiscard]] bool contains(std::uint16_t index) const noexcept;
    /// rt. All entries, ascending (index, sub-index).
    [[nodiscard]] std::span<const DictionaryEntry> entries() const noexcept { return entries_; }
    /// rt.
    [[nodiscard]] std::span<std::uint8_t> bytes(const DictionaryEntry& entry) noexcept {
        return std::span{values_}.subspan(entry.offset, entry.size);
    }
    [[nodiscard]] std::span<std::uint8_t> values() noexcept { return values_; }

    /// rt. The value as an unsigned or two's complement number.
    [[nodiscard]] std::uint64_t getUnsigned(ObjectRef ref) const noexcept {
        return load(ref.offset) & mask(ref.size);
    }
    [[nodiscard]] std::int64_t getSigned(ObjectRef ref) const noexcept {
        const std::uint64_t sign = std::uint64_t{1} << (8 * ref.size - 1);
        return static_cast<std::int64_t>((getUnsigned(ref) ^ sign) - sign);
    }
    /// rt. Stores the low bytes of `value`.
    void set(ObjectRef ref, std::int64_t value) noexcept {
        const std::uint64_t wanted = mask(ref.size);
        const std::uint64_t kept = load(ref.offset) & ~wanted;
        store(ref.offset, kept | (static_cast<std::uint64_t>(value) & wanted));
    }

    /// Marks an entry as mappable, as an entry of a default PDO obviously is.
    void allowMapping(std::uint16_t index, std::uint8_t subindex, bool toDevice);

private:
    [[nodiscard]] static std::uint64_t mask(std::uint8_t size) noexcept {
        return ~std::uint64_t{0} >> (64 - 8 * size);
    }
    [[nodiscard]] std::uint64_t load(std::uint32_t offset) const noexcept {
        if constexpr (std::endian::native == std::endian::little) {
            std::uint64_t word = 0;
            std::memcpy(&word, values_.data() + offset, sizeof word);
            return word;
        }
        return wire::load64(values_, offset);
    }
    void store(std::uint32_t offset, std::uint64_t word) noexcept {
        if constexpr (std::endian::native == std::endian::little) {
            std::memcpy(values_.data() + offset, &word, sizeof word);
        } else {
            wire::store64(values_, offset, word);
        }
    }
    [[nodiscard]] const DictionaryEntry* locate(std::uint16_t index,
                                                std::uint8_t subindex) const noexcept;
    [[nodiscard]] DictionaryEntry* locate(std::uint16_t index, std::uint8_t subindex) noexcept;
    DictionaryEntry& add(DictionaryEntry entry, std::size_t size);

    std::vector<DictionaryEntry> entries_;  ///< ascending (index, sub-index)
    std::vector<std::uint8_t> values_;      ///< used_ bytes and eight to spare
    std::size_t used_{0};
};

/// Bytes of a simple data type; 0 for strings.
[[nodiscard]] std::uint8_t sizeOf(wire::DataType type) noexcept;

}  // namespace takt::twin
