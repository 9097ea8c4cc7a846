#include "xml_encoding.hpp"

#include <libxml/encoding.h>
#include <libxml/parser.h>
#include <libxml/xmlschemas.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "numbers.hpp"

namespace takt::config {

namespace {

constexpr const char* KnownEncodings = "UTF-8, UTF-16, ISO-8859-1 and others that iconv knows";

int linesBefore(std::string_view text, std::size_t offset) noexcept {
    int lines = 0;
    for (const char c : text.substr(0, offset)) lines += c == '\n' ? 1 : 0;
    return lines;
}

/// How many bytes the character at the front has; 0 = not valid UTF-8 (RFC 3629) or no XML
/// character.
std::size_t characterLength(std::string_view text) noexcept {
    const auto byte = [text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t first = byte(0);
    if (first < 0x80U) {
        return first >= 0x20U || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
    }
    const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
    if (first < 0xC2U || first > 0xF4U || text.size() < length) return 0;
    std::uint32_t code = first & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) return 0;
        code = (code << 6U) | (byte(i) & 0x3FU);
    }
    const bool overlong = (length == 3 && code < 0x800U) || (length == 4 && code < 0x10000U);
    const bool surrogate = code >= 0xD800U && code <= 0xDFFFU;
    const bool nonCharacter = code == 0xFFFEU || code == 0xFFFFU || code > 0x10FFFFU;
    return overlong || surrogate || nonCharacter ? 0 : length;
}

/// Offset of the first byte that is not part of a good character.
std::optional<std::size_t> firstBadByte(std::string_view text) noexcept {
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t length = characterLength(text.substr(at));
        if (length == 0) return at;
        at += length;
    }
    return std::nullopt;
}

/// The encoding named in <?xml … encoding="…"?>, upper case; empty = none.
std::string declaredEncoding(std::string_view bytes) {
    if (!bytes.starts_with("<?xml")) return {};
    std::string_view head = bytes.substr(0, bytes.substr(0, 512).find("?>"));
    head = head.substr(0, 512);
    const std::size_t at = head.find("encoding");
    if (at == std::string_view::npos) return {};
    const std::size_t open = head.find_first_of("\"'", at);
    if (open == std::string_view::npos) return {};
    const std::size_t close = head.find(head[open], open + 1);
    if (close == std::string_view::npos) return {};
    std::string name{head.substr(open + 1, close - open - 1)};
    for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return name;
}

/// By the byte order mark, or by how "<?" looks in 16 bits, else as declared; empty = nothing is
/// told.
std::string encodingOf(std::string_view bytes) {
    const bool littleEndian =
        bytes.starts_with("\xFF\xFE") || bytes.starts_with(std::string_view{"<\0?\0", 4});
    const bool bigEndian =
        bytes.starts_with("\xFE\xFF") || bytes.starts_with(std::string_view{"\0<\0?", 4});
    if (littleEndian) return "UTF-16LE";
    if (bigEndian) return "UTF-16BE";
    return bytes.starts_with("\xEF\xBB\xBF") ? std::string{} : declaredEncoding(bytes);
}

struct BufferDeleter {
    void operator()(xmlBuffer* buffer) const noexcept { xmlBufferFree(buffer); }
};
using Buffer = std::unique_ptr<xmlBuffer, BufferDeleter>;

/// Converts by a handler of libxml2 (and iconv behind it); empty when a byte does not belong there.
std::optional<std::string> convert(xmlCharEncodingHandler* handler, std::string_view bytes) {
    const Buffer input{xmlBufferCreate()};
    const Buffer output{xmlBufferCreate()};
    std::string text;
    if (!input || !output ||
        xmlBufferAdd(input.get(), reinterpret_cast<const xmlChar*>(bytes.data()),
                     static_cast<int>(bytes.size())) != 0) {
        return std::nullopt;
    }
    while (xmlBufferLength(input.get()) > 0) {
        const int before = xmlBufferLength(input.get());
        const int written = xmlCharEncInFunc(handler, output.get(), input.get());
        if (written < 0 || xmlBufferLength(input.get()) == before) return std::nullopt;
        text.append(reinterpret_cast<const char*>(xmlBufferContent(output.get())),
                    static_cast<std::size_t>(xmlBufferLength(output.get())));
        xmlBufferEmpty(output.get());
    }
    return text;
}

Utf8Text convertFrom(const std::string& encoding, std::string_view bytes) {
    Utf8Text result;
    xmlCharEncodingHandler* const handler = xmlFindCharEncodingHandler(encoding.c_str());
    if (handler == nullptr) {
        result.problem = "the encoding '" + encoding + "' is not known";
        result.allowed = KnownEncodings;
        result.line = 1;
        return result;
    }
    auto text = convert(handler, bytes);
    xmlCharEncCloseFunc(handler);
    if (!text) {
        result.problem = "the text does not fit its encoding " + encoding;
        result.allowed = KnownEncodings;
        return result;
    }
    result.text = std::move(*text);
    return result;
}

bool isUtf8Name(const std::string& encoding) {
    return encoding.empty() || encoding == "UTF-8" || encoding == "UTF8" ||
           encoding == "US-ASCII" || encoding == "ASCII";
}

void dropMark(std::string& text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
}

void collect(void* target, xmlErrorPtr error) {
    auto* const messages = static_cast<std::vector<SchemaMessage>*>(target);
    const std::string_view text = error->message != nullptr ? error->message : "";
    messages->push_back({error->line, std::string{trim(text)}});
}

struct DocDeleter {
    void operator()(xmlDoc* document) const noexcept { xmlFreeDoc(document); }
};
struct SchemaParserDeleter {
    void operator()(xmlSchemaParserCtxt* parser) const noexcept { xmlSchemaFreeParserCtxt(parser); }
};
struct SchemaDeleter {
    void operator()(xmlSchema* schema) const noexcept { xmlSchemaFree(schema); }
};
struct ValidatorDeleter {
    void operator()(xmlSchemaValidCtxt* validator) const noexcept {
        xmlSchemaFreeValidCtxt(validator);
    }
};

}  // namespace

Utf8Text toUtf8(std::string_view bytes) {
    Utf8Text result;
    const std::string encoding = encodingOf(bytes);
    if (isUtf8Name(encoding)) {
        result.text = std::string{bytes};
    } else {
        result = convertFrom(encoding, bytes);
    }
    if (!result.problem.empty()) return result;
    dropMark(result.text);
    if (const auto bad = firstBadByte(result.text)) {
        result.problem = "there is a byte that is not valid UTF-8 text";
        result.allowed = KnownEncodings;
        result.line = 1 + linesBefore(result.text, *bad);
    }
    return result;
}

std::vector<SchemaMessage> validate(std::string_view text, std::string_view schema) {
    std::vector<SchemaMessage> messages;
    xmlSetStructuredErrorFunc(&messages, collect);
    const std::unique_ptr<xmlDoc, DocDeleter> document{xmlReadMemory(
        text.data(), static_cast<int>(text.size()), "machine.xml", "UTF-8", XML_PARSE_NONET)};
    const std::unique_ptr<xmlSchemaParserCtxt, SchemaParserDeleter> parser{
        xmlSchemaNewMemParserCtxt(schema.data(), static_cast<int>(schema.size()))};
    const std::unique_ptr<xmlSchema, SchemaDeleter> rules{parser ? xmlSchemaParse(parser.get())
                                                                 : nullptr};
    const std::unique_ptr<xmlSchemaValidCtxt, ValidatorDeleter> validator{
        rules ? xmlSchemaNewValidCtxt(rules.get()) : nullptr};
    if (document && validator) {
        xmlSchemaSetValidStructuredErrors(validator.get(), collect, &messages);
        xmlSchemaValidateDoc(validator.get(), document.get());
    } else if (messages.empty()) {
        messages.push_back({0, "the schema check could not run"});
    }
    xmlSetStructuredErrorFunc(nullptr, nullptr);
    return messages;
}

}  // namespace takt::config
