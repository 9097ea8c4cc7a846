#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <takt/record/csv_trace.hpp>
#include <takt/record/event_log.hpp>
#include <utility>

namespace takt::record {

namespace {

void appendHex(std::string& text, double value) {
    constexpr double Limit = 9.0e18;
    if (!(value >= 0.0 && value < Limit)) {
        appendNumber(text, value);
        return;
    }
    std::array<char, 16> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(),
                                   static_cast<std::uint64_t>(value), 16)
                         .ptr;
    const auto count = static_cast<std::size_t>(end - digits.data());
    text += "0x";
    text.append(count < 4 ? 4 - count : 0, '0');
    std::transform(digits.data(), end, std::back_inserter(text),
                   [](char c) { return c >= 'a' ? static_cast<char>(c - 'a' + 'A') : c; });
}

/// \return how many characters of `place` are a placeholder, 0 when it is plain text
std::size_t appendPlaceholder(std::string& text, std::string_view place, const Event& event) {
    const bool hex = place.size() > 1 && place[1] == 'x';
    const std::size_t digit = hex ? 2 : 1;
    if (place.size() < digit + 2 || place[digit + 1] != '}') return 0;
    const auto index = static_cast<std::size_t>(place[digit] - '0');
    if (place[digit] < '0' || index >= event.numbers.size()) return 0;
    if (hex) {
        appendHex(text, event.numbers[index]);
    } else {
        appendNumber(text, event.numbers[index]);
    }
    return digit + 2;
}

}  // namespace

EventFormatter::EventFormatter(std::vector<EventText> texts, std::vector<std::string> sources)
    : texts_{std::move(texts)}, sources_{std::move(sources)} {}

std::string EventFormatter::format(const Event& event) const {
    std::string line = "cycle ";
    appendNumber(line, static_cast<std::int64_t>(event.cycle));
    line += ' ';
    line += event.source < sources_.size() ? sources_[event.source]
                                           : "source " + std::to_string(event.source);
    line += ": ";
    const auto text = std::find_if(texts_.begin(), texts_.end(),
                                   [&](const EventText& t) { return t.id == event.id; });
    std::string_view sentence = "with {0}, {1}, {2}, {3}";
    if (text != texts_.end()) {
        sentence = text->sentence;
    } else {
        line += "event " + std::to_string(event.id) + ' ';
    }
    for (std::size_t i = 0; i < sentence.size();) {
        const std::size_t used =
            sentence[i] == '{' ? appendPlaceholder(line, sentence.substr(i), event) : 0;
        if (used == 0) line += sentence[i];
        i += used == 0 ? 1 : used;
    }
    return line;
}

}  // namespace takt::record
