#include "names.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace takt::config {

namespace {

constexpr std::size_t LongestCompared = 64;

char lower(char c) noexcept {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool isLetter(char c) noexcept {
    return (lower(c) >= 'a' && lower(c) <= 'z') || c == '_';
}

/// Letters to add, drop, change or swap with their neighbour; a change of case counts nothing.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> beforeLast;
    std::vector<std::size_t> last;
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    const auto same = [&](std::size_t i, std::size_t k) { return lower(a[i]) == lower(b[k]); };
    for (std::size_t i = 1; i <= a.size(); ++i) {
        beforeLast = std::move(last);
        last = row;
        row[0] = i;
        for (std::size_t k = 1; k <= b.size(); ++k) {
            const std::size_t change = last[k - 1] + (same(i - 1, k - 1) ? 0U : 1U);
            row[k] = std::min({last[k] + 1, row[k - 1] + 1, change});
            const bool swapped = i > 1 && k > 1 && same(i - 1, k - 2) && same(i - 2, k - 1);
            if (swapped) row[k] = std::min(row[k], beforeLast[k - 2] + 1);
        }
    }
    return row[b.size()];
}

}  // namespace

std::string nearestName(std::string_view wanted, std::span<const std::string> known) {
    if (wanted.size() > LongestCompared) return {};
    std::string nearest;
    std::size_t best = 1 + std::max<std::size_t>(1, wanted.size() / 3);
    for (const std::string& name : known) {
        const std::size_t found = distance(wanted, name);
        if (found >= best) continue;
        best = found;
        nearest = name;
    }
    return nearest;
}

std::string joined(std::span<const std::string> names) {
    std::string text;
    for (const std::string& name : names) {
        if (!text.empty()) text += ", ";
        text += name;
    }
    return text;
}

bool isName(std::string_view text) noexcept {
    constexpr std::size_t Longest = 32;
    if (text.empty() || text.size() > Longest || !isLetter(text[0])) return false;
    return std::all_of(text.begin(), text.end(), [](char c) {
        return isLetter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
    });
}

}  // namespace takt::config
