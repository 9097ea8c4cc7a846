#include "element_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "names.hpp"
#include "numbers.hpp"

namespace takt::config {

namespace {

constexpr double LongestTime = 3.6e12;  // ns: an hour

std::string rangeText(IntegerRange range) {
    constexpr IntegerRange All{};
    if (range.least == All.least && range.most == All.most) return "a whole number";
    if (range.most == All.most) return fmt::format("a whole number from {}", range.least);
    return fmt::format("a whole number from {} to {}", range.least, range.most);
}

std::string quantityText(Dimension dimension, Sign sign) {
    const char* const bound = sign == Sign::Positive      ? "above 0 "
                              : sign == Sign::NotNegative ? "from 0 "
                                                          : "";
    return fmt::format("a number {}with a unit ({}), for example \"{}\"", bound, unitsOf(dimension),
                       exampleOf(dimension));
}

bool fits(double value, Sign sign) noexcept {
    switch (sign) {
        case Sign::Any:
            return true;
        case Sign::NotNegative:
            return value >= 0.0;
        case Sign::Positive:
            return value > 0.0;
    }
    return false;
}

}  // namespace

ElementReader::ElementReader(XmlElement element, std::string label, std::string file,
                             Diagnostics& diagnostics)
    : element_{element},
      label_{std::move(label)},
      file_{std::move(file)},
      diagnostics_{&diagnostics} {}

ElementReader::ElementReader(Place place, std::string label, Diagnostics& diagnostics)
    : label_{std::move(label)},
      file_{std::move(place.file)},
      line_{place.line},
      diagnostics_{&diagnostics} {}

Place ElementReader::place() const {
    return {file_, element_.present() ? element_.line() : line_};
}

Place ElementReader::place(std::string_view attribute) const {
    const auto found = element_.attribute(attribute);
    return {file_, found ? found->line : place().line};
}

void ElementReader::error(std::string_view attribute, const std::string& what, std::string allowed,
                          std::string remedy) const {
    diagnostics_->error(place(attribute), label_ + ": " + what, std::move(allowed),
                        std::move(remedy));
}

void ElementReader::wrongValue(const XmlAttribute& attribute, const std::string& problem,
                               std::string allowed) const {
    diagnostics_->error(
        {file_, attribute.line},
        fmt::format("{}: {}=\"{}\": {}", label_, attribute.name, attribute.value, problem),
        std::move(allowed));
}

std::optional<XmlAttribute> ElementReader::ask(std::string_view name, Presence presence,
                                               const std::string& allowed) {
    askedAttributes_.emplace_back(name);
    const auto attribute = element_.attribute(name);
    if (!attribute && presence == Presence::Required && element_.present()) {
        missing_.push_back({std::string{name}, true, allowed});
    }
    return attribute;
}

std::optional<std::string> ElementReader::text(std::string_view name, Presence presence) {
    const auto attribute = ask(name, presence, "some text");
    if (!attribute) return std::nullopt;
    const std::string_view value = trim(attribute->value);
    if (value.empty()) {
        wrongValue(*attribute, "the text is empty", "some text");
        return std::nullopt;
    }
    return std::string{value};
}

std::optional<std::string> ElementReader::name(std::string_view name, Presence presence) {
    const std::string allowed =
        "a name of at most 32 characters: a letter, then letters, digits, '_', '-' or '.'";
    const auto attribute = ask(name, presence, allowed);
    if (!attribute) return std::nullopt;
    if (!isName(attribute->value)) {
        wrongValue(*attribute, "this is not a name", allowed);
        return std::nullopt;
    }
    return std::string{attribute->value};
}

std::optional<bool> ElementReader::flag(std::string_view name, Presence presence) {
    const auto attribute = ask(name, presence, "true, false");
    if (!attribute) return std::nullopt;
    const auto value = parseBool(attribute->value);
    if (!value) wrongValue(*attribute, "this is neither true nor false", "true, false");
    return value;
}

std::optional<std::int64_t> ElementReader::integer(std::string_view name, IntegerRange range,
                                                   Presence presence) {
    const std::string allowed = rangeText(range) + ", hexadecimal as 0x…";
    const auto attribute = ask(name, presence, allowed);
    if (!attribute) return std::nullopt;
    const auto value = parseInteger(trim(attribute->value));
    if (!value) {
        wrongValue(*attribute, "this is not a whole number", allowed);
        return std::nullopt;
    }
    if (*value < range.least || *value > range.most) {
        wrongValue(*attribute, "this is out of range", allowed);
        return std::nullopt;
    }
    return value;
}

std::optional<Quantity> ElementReader::quantity(std::string_view name, Dimension dimension,
                                                Sign sign, Presence presence) {
    const std::string allowed = quantityText(dimension, sign);
    const auto attribute = ask(name, presence, allowed);
    if (!attribute) return std::nullopt;
    std::string problem;
    const auto value = parseQuantity(attribute->value, dimension, problem);
    if (!value) {
        wrongValue(*attribute, problem, allowed);
        return std::nullopt;
    }
    if (!fits(value->value, sign)) {
        wrongValue(*attribute,
                   value->value < 0.0 ? "this must not be negative" : "this must not be 0",
                   allowed);
        return std::nullopt;
    }
    return value;
}

std::optional<core::Duration> ElementReader::time(std::string_view name, Sign sign,
                                                  Presence presence) {
    const auto value = quantity(name, Dimension::Time, sign, presence);
    if (!value) return std::nullopt;
    const bool whole = value->exact && value->exact->denominator == 1;
    if (!whole || value->value > LongestTime || value->value < -LongestTime) {
        wrongValue(*element_.attribute(name),
                   whole ? "this is too long" : "this is not a whole number of nanoseconds",
                   whole ? "at most 60 min" : "whole nanoseconds");
        return std::nullopt;
    }
    return core::Duration{value->exact->numerator};
}

std::vector<XmlElement> ElementReader::children(std::string_view name) {
    askedChildren_.emplace_back(name);
    return element_.children(name);
}

ElementReader ElementReader::childReader(std::string_view name, Presence presence) {
    const std::vector<XmlElement> found = children(name);
    for (std::size_t i = 1; i < found.size(); ++i) {
        diagnostics_->error({file_, found[i].line()},
                            fmt::format("{}: there is a second <{}>", label_, name), "one",
                            fmt::format("remove it, or join it with line {}", found[0].line()));
    }
    if (found.empty() && presence == Presence::Required && element_.present()) {
        missing_.push_back({std::string{name}, false, {}});
    }
    return {found.empty() ? XmlElement{} : found.front(), fmt::format("{}, <{}>", label_, name),
            file_, *diagnostics_};
}

void ElementReader::unknown(std::string_view name, int line, bool attribute) {
    const auto& known = attribute ? askedAttributes_ : askedChildren_;
    const std::string nearest = nearestName(name, known);
    std::erase_if(missing_, [&](const Missing& missing) {
        return missing.attribute == attribute && missing.name == nearest;
    });
    const std::string shown =
        attribute ? fmt::format("attribute '{}'", name) : fmt::format("element <{}>", name);
    const std::string hint =
        nearest.empty() ? std::string{} : fmt::format(", did you mean '{}'?", nearest);
    diagnostics_->error({file_, line},
                        fmt::format("{}: the {} is not known here{}", label_, shown, hint),
                        known.empty() ? "none" : joined(known));
}

void ElementReader::finish() {
    if (!element_.present()) return;
    for (const XmlAttribute& attribute : element_.attributes()) {
        const bool schemaHint =
            attribute.name.starts_with("xmlns") || attribute.name.starts_with("xsi:");
        if (schemaHint || std::find(askedAttributes_.begin(), askedAttributes_.end(),
                                    attribute.name) != askedAttributes_.end()) {
            continue;
        }
        unknown(attribute.name, attribute.line, true);
    }
    for (const XmlElement child : element_.children()) {
        if (std::find(askedChildren_.begin(), askedChildren_.end(), child.name()) ==
            askedChildren_.end()) {
            unknown(child.name(), child.line(), false);
        }
    }
    if (const std::string text = element_.text(); !text.empty()) {
        diagnostics_->error(place(), fmt::format("{}: there is text in the element", label_),
                            "attributes and elements only");
    }
    for (const Missing& missing : missing_) {
        diagnostics_->error(
            place(),
            missing.attribute
                ? fmt::format("{}: the attribute '{}' is missing", label_, missing.name)
                : fmt::format("{}: the element <{}> is missing", label_, missing.name),
            missing.allowed);
    }
}

}  // namespace takt::config
