#include "numbers.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <system_error>

namespace takt::config {

namespace {

constexpr std::int64_t MaxInt64 = std::numeric_limits<std::int64_t>::max();
constexpr int MaxPowerOfTen = 18;  // 10^18 is the largest in 64 bits

bool isDigit(char c) noexcept {
    return c >= '0' && c <= '9';
}

bool isBlank(char c) noexcept {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool multiplyChecked(std::int64_t a, std::int64_t b, std::int64_t& product) noexcept {
    return !__builtin_mul_overflow(a, b, &product);
}

std::optional<std::int64_t> powerOfTen(int exponent) noexcept {
    if (exponent < 0 || exponent > MaxPowerOfTen) return std::nullopt;
    std::int64_t power = 1;
    for (int i = 0; i < exponent; ++i) power *= 10;
    return power;
}

std::size_t digitsFrom(std::string_view text, std::size_t start) noexcept {
    std::size_t end = start;
    while (end < text.size() && isDigit(text[end])) ++end;
    return end;
}

/// The digits of a checked decimal as mantissa · 10^exponent; empty when too long for 64 bits.
std::optional<Ratio> exactFraction(std::string_view number) noexcept {
    const bool negative = number.front() == '-';
    std::int64_t mantissa = 0;
    int exponent = 0;
    int zeros = 0;  // trailing zeros held back: "1.500000000000000000000" is still exact
    bool fraction = false;
    std::size_t i = number.front() == '-' || number.front() == '+' ? 1 : 0;
    for (; i < number.size() && number[i] != 'e' && number[i] != 'E'; ++i) {
        if (number[i] == '.') {
            fraction = true;
            continue;
        }
        exponent -= fraction ? 1 : 0;
        ++zeros;
        if (number[i] == '0') continue;
        for (; zeros > 0; --zeros) {
            if (!multiplyChecked(mantissa, 10, mantissa)) return std::nullopt;
        }
        if (__builtin_add_overflow(mantissa, number[i] - '0', &mantissa)) return std::nullopt;
    }
    exponent += zeros;
    if (i < number.size()) {
        const std::size_t start = number[i + 1] == '+' ? i + 2 : i + 1;
        int written = 0;
        const auto end =
            std::from_chars(number.data() + start, number.data() + number.size(), written);
        if (end.ec != std::errc{} || written > 400 || written < -400) return std::nullopt;
        exponent += written;
    }
    if (mantissa == 0) return Ratio{0, 1};
    const auto power = powerOfTen(exponent < 0 ? -exponent : exponent);
    if (!power) return std::nullopt;
    if (negative) mantissa = -mantissa;
    return exponent < 0 ? makeRatio(mantissa, *power)
                        : multiply(Ratio{mantissa, 1}, Ratio{*power, 1});
}

std::optional<Ratio> parseRatioPart(std::string_view text) noexcept {
    NumberFault fault{};
    const auto number = parseDecimal(trim(text), fault);
    constexpr double Largest = 2147483648.0;
    if (!number || !number->exact || number->value <= 0.0 || number->value > Largest) {
        return std::nullopt;
    }
    return number->exact;
}

}  // namespace

std::optional<Ratio> makeRatio(std::int64_t numerator, std::int64_t denominator) noexcept {
    if (denominator == 0 || numerator == std::numeric_limits<std::int64_t>::min() ||
        denominator == std::numeric_limits<std::int64_t>::min()) {
        return std::nullopt;
    }
    const std::int64_t divisor = std::gcd(numerator, denominator);
    const std::int64_t sign = denominator < 0 ? -1 : 1;
    return Ratio{sign * numerator / divisor, sign * denominator / divisor};
}

std::optional<Ratio> multiply(Ratio a, Ratio b) noexcept {
    // Cross-cancelling first keeps the products as small as they can be.
    const auto left = makeRatio(a.numerator, b.denominator);
    const auto right = makeRatio(b.numerator, a.denominator);
    if (!left || !right) return std::nullopt;
    Ratio product;
    if (!multiplyChecked(left->numerator, right->numerator, product.numerator) ||
        !multiplyChecked(left->denominator, right->denominator, product.denominator)) {
        return std::nullopt;
    }
    return product;
}

std::string_view trim(std::string_view text) noexcept {
    while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
    return text;
}

std::optional<std::int64_t> parseInteger(std::string_view text) noexcept {
    const bool hex =
        text.size() > 2 && (text[0] == '0' || text[0] == '#') && (text[1] == 'x' || text[1] == 'X');
    const bool plus = text.size() > 1 && text[0] == '+' && isDigit(text[1]);
    std::uint64_t magnitude = 0;
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
    if (hex) {
        const auto parsed = std::from_chars(text.data() + 2, end, magnitude, 16);
        if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
        if (magnitude > static_cast<std::uint64_t>(MaxInt64)) return std::nullopt;
        return static_cast<std::int64_t>(magnitude);
    }
    const auto parsed = std::from_chars(text.data() + (plus ? 1 : 0), end, value);
    if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
    return value;
}

std::optional<bool> parseBool(std::string_view text) noexcept {
    if (text == "1" || text == "true") return true;
    if (text == "0" || text == "false") return false;
    return std::nullopt;
}

std::size_t numberLength(std::string_view text) noexcept {
    const std::size_t start = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
    std::size_t end = digitsFrom(text, start);
    if (end == start) return 0;
    if (end + 1 < text.size() && text[end] == '.' && isDigit(text[end + 1])) {
        end = digitsFrom(text, end + 1);
    }
    if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
        const std::size_t sign =
            end + 1 < text.size() && (text[end + 1] == '-' || text[end + 1] == '+') ? 1 : 0;
        const std::size_t exponent = digitsFrom(text, end + 1 + sign);
        if (exponent > end + 1 + sign) end = exponent;
    }
    return end;
}

std::optional<Decimal> parseDecimal(std::string_view text, NumberFault& fault) noexcept {
    fault = NumberFault::NotANumber;
    if (text.empty() || numberLength(text) != text.size()) return std::nullopt;
    Decimal number;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), end, number.value);
    if (parsed.ec == std::errc::result_out_of_range || !std::isfinite(number.value)) {
        fault = NumberFault::OutOfRange;
        return std::nullopt;
    }
    if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
    number.exact = exactFraction(text);
    fault = NumberFault::None;
    return number;
}

std::optional<Ratio> parseRatio(std::string_view text) noexcept {
    const std::size_t bar = text.find_first_of("/:");
    const auto first = parseRatioPart(text.substr(0, bar));
    if (!first || bar == std::string_view::npos) return first;
    const auto second = parseRatioPart(text.substr(bar + 1));
    if (!second) return std::nullopt;
    return multiply(*first, Ratio{second->denominator, second->numerator});
}

}  // namespace takt::config
