#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <takt/config/diagnostics.hpp>
#include <vector>

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace takt::config {

struct XmlAttribute {
    std::string_view name;
    std::string_view value;
    int line{0};
};

/// A handle to one element; valid as long as its document. A default-made one stands for "not
/// there" and has neither attributes nor children.
class XmlElement {
public:
    XmlElement() = default;
    explicit XmlElement(const tinyxml2::XMLElement* node) noexcept : node_{node} {}

    [[nodiscard]] bool present() const noexcept { return node_ != nullptr; }
    [[nodiscard]] std::string_view name() const noexcept;
    [[nodiscard]] int line() const noexcept;
    /// The element's own text and CDATA, blanks at both ends removed.
    [[nodiscard]] std::string text() const;
    [[nodiscard]] std::vector<XmlAttribute> attributes() const;
    [[nodiscard]] std::optional<XmlAttribute> attribute(std::string_view name) const noexcept;
    [[nodiscard]] std::vector<XmlElement> children() const;
    [[nodiscard]] std::vector<XmlElement> children(std::string_view name) const;
    /// The first child of that name.
    [[nodiscard]] XmlElement child(std::string_view name) const noexcept;

private:
    const tinyxml2::XMLElement* node_{nullptr};
};

class XmlDocument {
public:
    XmlDocument(std::string file, std::string text, std::unique_ptr<tinyxml2::XMLDocument> dom);
    XmlDocument(XmlDocument&&) noexcept;
    XmlDocument& operator=(XmlDocument&&) noexcept;
    ~XmlDocument();

    [[nodiscard]] const std::string& file() const noexcept { return file_; }
    /// The whole text as UTF-8, without byte order mark.
    [[nodiscard]] const std::string& text() const noexcept { return text_; }
    [[nodiscard]] XmlElement root() const noexcept;

private:
    std::string file_;
    std::string text_;
    std::unique_ptr<tinyxml2::XMLDocument> dom_;
};

inline constexpr std::size_t MaxMachineFile = std::size_t{16} << 20U;
inline constexpr std::size_t MaxDeviceFile = std::size_t{64} << 20U;

/// Reads a file of at most `maxBytes` and takes it apart. Whatever the file's encoding is, the
/// document is UTF-8. Refused: DOCTYPE and other declarations, more than one root, invalid
/// characters, doubled attributes, nesting of more than 100.
[[nodiscard]] std::optional<XmlDocument> loadXml(const std::filesystem::path& file,
                                                 std::size_t maxBytes, Diagnostics& diagnostics);

}  // namespace takt::config
