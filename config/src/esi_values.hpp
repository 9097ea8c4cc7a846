#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <takt/config/diagnostics.hpp>
#include <takt/core/time.hpp>
#include <vector>

#include "xml_document.hpp"

namespace takt::config {

/// Reads single values of a device description. Where a value is wrong it is reported and the
/// fallback taken; where it is absent the fallback is taken silently, as ETG.2000 makes nearly
/// everything optional.
class EsiValues {
public:
    EsiValues(std::string file, Diagnostics& diagnostics)
        : file_{std::move(file)}, diagnostics_{&diagnostics} {}

    [[nodiscard]] const std::string& file() const noexcept { return file_; }

    /// HexDecValue: decimal or "#x…" (some files: "0x…"), from the text of a child element.
    [[nodiscard]] std::int64_t child(XmlElement element, std::string_view name, std::int64_t least,
                                     std::int64_t most, std::int64_t fallback) const;
    /// The same from an attribute.
    [[nodiscard]] std::int64_t attribute(XmlElement element, std::string_view name,
                                         std::int64_t least, std::int64_t most,
                                         std::int64_t fallback) const;
    /// "1", "true", "0", "false", or any other number: not 0.
    [[nodiscard]] bool flag(XmlElement element, std::string_view name, bool fallback) const;
    /// Milliseconds in a child element.
    [[nodiscard]] core::Duration milliseconds(XmlElement element, std::string_view name,
                                              core::Duration fallback) const;
    /// The value of a text that stands in `line`.
    [[nodiscard]] std::optional<std::int64_t> number(std::string_view text, int line,
                                                     std::string_view what, std::int64_t least,
                                                     std::int64_t most) const;

    void error(int line, std::string what, std::string allowed = {}) const {
        diagnostics_->error({file_, line}, std::move(what), std::move(allowed));
    }
    void note(int line, std::string what) const {
        diagnostics_->note({file_, line}, std::move(what));
    }

private:
    std::string file_;
    Diagnostics* diagnostics_;
};

/// hexBinary: pairs of hexadecimal digits.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> hexBytes(std::string_view text);

/// The English name of an element with several <Name LcId="…">, else the first.
[[nodiscard]] std::string englishName(XmlElement element);

}  // namespace takt::config
