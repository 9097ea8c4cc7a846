#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace takt::config {

/// The outcome of a conversion; `problem` is empty when it went well.
struct Utf8Text {
    std::string text;  ///< without byte order mark
    std::string problem;
    std::string allowed;
    int line{0};  ///< of the problem
};

/// Makes UTF-8 of an XML file, going by its byte order mark or its declared encoding, and checks
/// it.
[[nodiscard]] Utf8Text toUtf8(std::string_view bytes);

struct SchemaMessage {
    int line{0};
    std::string text;
};

/// Checks an XML text against a schema; both are UTF-8 without document type declaration.
/// Nothing is fetched from anywhere.
[[nodiscard]] std::vector<SchemaMessage> validate(std::string_view text, std::string_view schema);

}  // namespace takt::config
