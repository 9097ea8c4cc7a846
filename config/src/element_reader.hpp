#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <takt/config/diagnostics.hpp>
#include <takt/core/time.hpp>
#include <utility>
#include <vector>

#include "quantity.hpp"
#include "xml_document.hpp"

namespace takt::config {

enum class Presence : std::uint8_t { Required, Optional };
enum class Sign : std::uint8_t { Any, NotNegative, Positive };

struct IntegerRange {
    std::int64_t least{std::numeric_limits<std::int64_t>::min()};
    std::int64_t most{std::numeric_limits<std::int64_t>::max()};
};

/// Reads one element of a machine file strictly: each attribute and child is asked for by name, and
/// whatever was not asked for is an error with the nearest name that was.
///
///     ElementReader limits = axis.childReader("Limits", Presence::Required);
///     const auto velocity = limits.quantity("velocity", Dimension::LinearVelocity);
///     …
///     limits.finish();
///
/// Every value comes back empty where it is absent or wrong; what was wrong has been reported.
class ElementReader {
public:
    /// \param label how messages call the element, e.g. "axis 'X'"
    ElementReader(XmlElement element, std::string label, std::string file,
                  Diagnostics& diagnostics);

    /// For what stands in a file that is read otherwise: it has a place and no attributes.
    ElementReader(Place place, std::string label, Diagnostics& diagnostics);

    [[nodiscard]] bool present() const noexcept { return element_.present(); }
    [[nodiscard]] XmlElement element() const noexcept { return element_; }
    [[nodiscard]] const std::string& label() const noexcept { return label_; }
    [[nodiscard]] Diagnostics& diagnostics() const noexcept { return *diagnostics_; }
    void relabel(std::string label) { label_ = std::move(label); }

    /// The element's place, or that of one of its attributes where it is written.
    [[nodiscard]] Place place() const;
    [[nodiscard]] Place place(std::string_view attribute) const;

    std::optional<std::string> text(std::string_view name, Presence presence = Presence::Optional);
    /// A name by isName().
    std::optional<std::string> name(std::string_view name, Presence presence = Presence::Required);
    std::optional<bool> flag(std::string_view name, Presence presence = Presence::Optional);
    std::optional<std::int64_t> integer(std::string_view name, IntegerRange range,
                                        Presence presence = Presence::Optional);
    std::optional<Quantity> quantity(std::string_view name, Dimension dimension,
                                     Sign sign = Sign::Any, Presence presence = Presence::Optional);
    /// A time of whole nanoseconds, at most an hour.
    std::optional<core::Duration> time(std::string_view name, Sign sign = Sign::NotNegative,
                                       Presence presence = Presence::Optional);
    template <typename T>
    std::optional<T> choice(std::string_view name,
                            const std::vector<std::pair<std::string, T>>& choices,
                            Presence presence = Presence::Optional);

    /// All children of a name.
    std::vector<XmlElement> children(std::string_view name);
    /// The only child of a name; a second one is an error. Not present() when it is absent.
    ElementReader childReader(std::string_view name, Presence presence = Presence::Optional);

    /// Reports what was not asked for and what was missing. To be called once, last.
    void finish();

    void error(std::string_view attribute, const std::string& what, std::string allowed = {},
               std::string remedy = {}) const;

private:
    struct Missing {
        std::string name;
        bool attribute{true};
        std::string allowed;
    };

    std::optional<XmlAttribute> ask(std::string_view name, Presence presence,
                                    const std::string& allowed);
    void wrongValue(const XmlAttribute& attribute, const std::string& problem,
                    std::string allowed) const;
    void unknown(std::string_view name, int line, bool attribute);

    XmlElement element_;
    std::string label_;
    std::string file_;
    int line_{0};  ///< where there is no element
    Diagnostics* diagnostics_;
    std::vector<std::string> askedAttributes_;
    std::vector<std::string> askedChildren_;
    std::vector<Missing> missing_;
};

template <typename T>
std::optional<T> ElementReader::choice(std::string_view name,
                                       const std::vector<std::pair<std::string, T>>& choices,
                                       Presence presence) {
    std::string allowed;
    for (const auto& [word, value] : choices) allowed += (allowed.empty() ? "" : ", ") + word;
    const auto attribute = ask(name, presence, allowed);
    if (!attribute) return std::nullopt;
    for (const auto& [word, value] : choices) {
        if (attribute->value == word) return value;
    }
    wrongValue(*attribute, "this is not one of the choices", allowed);
    return std::nullopt;
}

}  // namespace takt::config
