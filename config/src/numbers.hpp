#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

/// Strict numbers: the whole text or nothing, no locale, no silent overflow, no nan and no inf.
namespace takt::config {

/// A positive or negative fraction in lowest terms; the denominator is positive.
struct Ratio {
    std::int64_t numerator{0};
    std::int64_t denominator{1};

    [[nodiscard]] double value() const noexcept {
        return static_cast<double>(numerator) / static_cast<double>(denominator);
    }
};

/// \return empty where a 64-bit number does not hold the result, or for a denominator of 0
[[nodiscard]] std::optional<Ratio> makeRatio(std::int64_t numerator,
                                             std::int64_t denominator) noexcept;
[[nodiscard]] std::optional<Ratio> multiply(Ratio a, Ratio b) noexcept;

/// Text without blanks at both ends.
[[nodiscard]] std::string_view trim(std::string_view text) noexcept;

/// Decimal ("-12"), or hexadecimal as "0x1A" or, as ESI files write it, "#x1A".
[[nodiscard]] std::optional<std::int64_t> parseInteger(std::string_view text) noexcept;

/// "1", "true", "0", "false".
[[nodiscard]] std::optional<bool> parseBool(std::string_view text) noexcept;

struct Decimal {
    double value{0.0};
    std::optional<Ratio> exact;  ///< empty when 64-bit numbers do not hold the fraction
};

enum class NumberFault : std::uint8_t { None, NotANumber, OutOfRange };

/// How many characters at the front are a decimal number ("-1.5e3"); 0 = none.
[[nodiscard]] std::size_t numberLength(std::string_view text) noexcept;

/// \param fault why there is no value
[[nodiscard]] std::optional<Decimal> parseDecimal(std::string_view text,
                                                  NumberFault& fault) noexcept;

/// "3", "1/10", "1:10", "2.5": positive numbers of at most 2^31.
[[nodiscard]] std::optional<Ratio> parseRatio(std::string_view text) noexcept;

}  // namespace takt::config
