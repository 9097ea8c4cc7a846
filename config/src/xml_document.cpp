#include "xml_document.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <system_error>
#include <utility>

#include "numbers.hpp"
#include "xml_encoding.hpp"

namespace takt::config {

namespace {

std::optional<std::string> readFile(const std::filesystem::path& file, std::size_t maxBytes,
                                    Diagnostics& diagnostics) {
    std::error_code fault;
    if (!std::filesystem::is_regular_file(file, fault)) {
        diagnostics.error({file.string(), 0}, "there is no such file", {},
                          "check the path; relative paths start at the file that names them");
        return std::nullopt;
    }
    const auto size = std::filesystem::file_size(file, fault);
    if (fault || size > maxBytes) {
        diagnostics.error({file.string(), 0}, "the file is too large",
                          fmt::format("at most {} MiB", maxBytes >> 20U));
        return std::nullopt;
    }
    std::ifstream stream{file, std::ios::binary};
    std::string bytes(size, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!stream || static_cast<std::uintmax_t>(stream.gcount()) != size) {
        diagnostics.error({file.string(), 0}, "the file cannot be read", {},
                          "check its permissions");
        return std::nullopt;
    }
    return bytes;
}

/// Where "<!…" other than a comment or CDATA begins; npos = nowhere. Declarations are refused
/// before any library sees them: they may define entities.
std::size_t findDeclaration(std::string_view text) noexcept {
    std::size_t at = text.find('<');
    while (at != std::string_view::npos) {
        const std::string_view rest = text.substr(at);
        std::string_view end = "<";
        if (rest.starts_with("<!--")) {
            end = "-->";
        } else if (rest.starts_with("<![CDATA[")) {
            end = "]]>";
        } else if (rest.starts_with("<?")) {
            end = "?>";
        } else if (rest.starts_with("<!")) {
            return at;
        }
        const std::size_t next = text.find(end, at + 1);
        if (next == std::string_view::npos) return next;
        at = end == "<" ? next : text.find('<', next);
    }
    return at;
}

/// Where an element with more attributes than any real file has begins; npos = nowhere. The library
/// compares every attribute with all before it, so their number must be bounded first.
std::size_t findCrowdedTag(std::string_view text) noexcept {
    constexpr std::ptrdiff_t MostAttributes = 1000;
    for (std::size_t at = text.find('<'); at != std::string_view::npos;) {
        const std::size_t next = text.find('<', at + 1);
        const std::string_view tag = text.substr(at, next - at);
        const bool element = tag.size() > 1 && tag[1] != '!' && tag[1] != '?' && tag[1] != '/';
        if (element && std::count(tag.begin(), tag.end(), '=') > MostAttributes) return at;
        at = next;
    }
    return std::string_view::npos;
}

int lineAt(std::string_view text, std::size_t offset) noexcept {
    int line = 1;
    for (const char c : text.substr(0, offset)) line += c == '\n' ? 1 : 0;
    return line;
}

bool checkRoot(const tinyxml2::XMLDocument& dom, const std::string& file,
               Diagnostics& diagnostics) {
    int roots = 0;
    bool clean = true;
    for (const auto* node = dom.FirstChild(); node != nullptr; node = node->NextSibling()) {
        const bool element = node->ToElement() != nullptr;
        roots += element ? 1 : 0;
        const bool strayText = node->ToText() != nullptr;
        if ((!element || roots < 2) && !strayText) continue;
        clean = false;
        diagnostics.error(
            {file, node->GetLineNum()},
            strayText ? "there is text outside the root element" : "there is a second root element",
            "one root element");
    }
    if (roots == 0) {
        diagnostics.error({file, 0}, "the file holds no XML element", "one root element");
    }
    return clean && roots == 1;
}

const char* explain(tinyxml2::XMLError error) noexcept {
    switch (error) {
        case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
            return "an element is not closed, or closed by another name";
        case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
            return "an attribute is not written as name=\"value\", or is there twice";
        case tinyxml2::XML_ERROR_PARSING_COMMENT:
            return "a comment does not end";
        case tinyxml2::XML_ERROR_PARSING_CDATA:
            return "a CDATA section does not end";
        case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
            return "the file is empty";
        case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
            return "elements are nested deeper than 100";
        default:
            return "this is not well-formed XML";
    }
}

}  // namespace

XmlDocument::XmlDocument(std::string file, std::string text,
                         std::unique_ptr<tinyxml2::XMLDocument> dom)
    : file_{std::move(file)}, text_{std::move(text)}, dom_{std::move(dom)} {}
XmlDocument::XmlDocument(XmlDocument&&) noexcept = default;
XmlDocument& XmlDocument::operator=(XmlDocument&&) noexcept = default;
XmlDocument::~XmlDocument() = default;

XmlElement XmlDocument::root() const noexcept {
    return XmlElement{dom_->RootElement()};
}

std::string_view XmlElement::name() const noexcept {
    return node_ != nullptr ? std::string_view{node_->Name()} : std::string_view{};
}

int XmlElement::line() const noexcept {
    return node_ != nullptr ? node_->GetLineNum() : 0;
}

std::string XmlElement::text() const {
    std::string all;
    if (node_ == nullptr) return all;
    for (const auto* node = node_->FirstChild(); node != nullptr; node = node->NextSibling()) {
        if (node->ToText() != nullptr) all += node->Value();
    }
    return std::string{trim(all)};
}

std::vector<XmlAttribute> XmlElement::attributes() const {
    std::vector<XmlAttribute> all;
    if (node_ == nullptr) return all;
    for (const auto* attribute = node_->FirstAttribute(); attribute != nullptr;
         attribute = attribute->Next()) {
        all.push_back({attribute->Name(), attribute->Value(), attribute->GetLineNum()});
    }
    return all;
}

std::optional<XmlAttribute> XmlElement::attribute(std::string_view name) const noexcept {
    if (node_ == nullptr) return std::nullopt;
    for (const auto* attribute = node_->FirstAttribute(); attribute != nullptr;
         attribute = attribute->Next()) {
        if (name != attribute->Name()) continue;
        return XmlAttribute{attribute->Name(), attribute->Value(), attribute->GetLineNum()};
    }
    return std::nullopt;
}

std::vector<XmlElement> XmlElement::children() const {
    std::vector<XmlElement> all;
    if (node_ == nullptr) return all;
    for (const auto* child = node_->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
        all.emplace_back(child);
    }
    return all;
}

std::vector<XmlElement> XmlElement::children(std::string_view name) const {
    std::vector<XmlElement> all;
    for (const XmlElement child : children()) {
        if (child.name() == name) all.push_back(child);
    }
    return all;
}

XmlElement XmlElement::child(std::string_view name) const noexcept {
    if (node_ == nullptr) return {};
    for (const auto* child = node_->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
        if (name == child->Name()) return XmlElement{child};
    }
    return {};
}

std::optional<XmlDocument> loadXml(const std::filesystem::path& file, std::size_t maxBytes,
                                   Diagnostics& diagnostics) {
    const std::string name = file.string();
    const auto bytes = readFile(file, maxBytes, diagnostics);
    if (!bytes) return std::nullopt;
    Utf8Text converted = toUtf8(*bytes);
    if (!converted.problem.empty()) {
        diagnostics.error({name, converted.line}, converted.problem, converted.allowed);
        return std::nullopt;
    }
    std::string text = std::move(converted.text);
    if (const std::size_t at = findDeclaration(text); at != std::string::npos) {
        diagnostics.error({name, lineAt(text, at)}, "a document type declaration is not accepted",
                          "plain XML without <!DOCTYPE> and entities", "remove the declaration");
        return std::nullopt;
    }
    if (const std::size_t at = findCrowdedTag(text); at != std::string::npos) {
        diagnostics.error({name, lineAt(text, at)}, "an element has too many attributes",
                          "at most 1000");
        return std::nullopt;
    }
    auto dom = std::make_unique<tinyxml2::XMLDocument>();
    if (dom->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
        diagnostics.error({name, dom->ErrorLineNum()}, explain(dom->ErrorID()), "well-formed XML");
        return std::nullopt;
    }
    if (!checkRoot(*dom, name, diagnostics)) return std::nullopt;
    return XmlDocument{name, std::move(text), std::move(dom)};
}

}  // namespace takt::config
