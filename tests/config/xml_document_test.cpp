#include "xml_document.hpp"

#include <gtest/gtest.h>

#include "test_files.hpp"
#include "xml_encoding.hpp"

namespace takt::config {
namespace {

using test::firstOf;
using test::ScratchFolder;

class XmlFile : public testing::Test {
protected:
    std::optional<XmlDocument> load(std::string_view bytes, std::size_t most = MaxMachineFile) {
        return loadXml(folder_.write("file.xml", bytes), most, diagnostics_);
    }
    void expectRefused(std::string_view bytes, int line, std::string_view what) {
        EXPECT_FALSE(load(bytes));
        ASSERT_EQ(diagnostics_.errorCount(), 1U) << format(diagnostics_);
        const Diagnostic error = firstOf(diagnostics_, Severity::Error);
        EXPECT_EQ(error.place.line, line) << format(diagnostics_);
        EXPECT_NE(error.what.find(what), std::string::npos) << format(diagnostics_);
    }

    ScratchFolder folder_;
    Diagnostics diagnostics_;
};

std::string utf16(std::string_view ascii, bool littleEndian, bool mark) {
    std::string bytes;
    const auto put = [&](unsigned code) {
        const char low = static_cast<char>(code & 0xFFU);
        const char high = static_cast<char>(code >> 8U);
        bytes += littleEndian ? low : high;
        bytes += littleEndian ? high : low;
    };
    if (mark) put(0xFEFF);
    for (const char c : ascii) put(static_cast<unsigned char>(c));
    return bytes;
}

TEST_F(XmlFile, KnowsLinesOfElementsAndAttributes) {
    const auto document = load("<A>\n <B x='1'\n    y='2'/>\n</A>");
    ASSERT_TRUE(document);
    const XmlElement child = document->root().child("B");
    EXPECT_EQ(child.line(), 2);
    EXPECT_EQ(child.attribute("y")->line, 3);
    EXPECT_EQ(child.attribute("y")->value, "2");
}

TEST_F(XmlFile, JoinsTextAndCdata) {
    const auto document = load("<A> one <![CDATA[<two>]]><!-- no --> &amp; three </A>");
    ASSERT_TRUE(document);
    EXPECT_EQ(document->root().text(), "one <two> & three");
}

TEST_F(XmlFile, ReadsAByteOrderMark) {
    const auto document = load("\xEF\xBB\xBF<?xml version=\"1.0\"?><A/>");
    ASSERT_TRUE(document);
    EXPECT_EQ(document->root().name(), "A");
}

TEST_F(XmlFile, ReadsLatin1AsTheHeadSays) {
    for (const char* name : {"ISO-8859-1", "ISO8859-1", "iso-8859-1"}) {
        const auto document =
            load("<?xml version=\"1.0\" encoding=\"" + std::string{name} + "\"?><A>\xE4\xB5</A>");
        ASSERT_TRUE(document) << name << format(diagnostics_);
        EXPECT_EQ(document->root().text(), "äµ") << name;
    }
}

TEST_F(XmlFile, ReadsUtf16InBothOrdersWithAndWithoutMark) {
    const std::string text = "<?xml version=\"1.0\" encoding=\"UTF-16\"?>\n<A>x</A>";
    for (const bool littleEndian : {true, false}) {
        for (const bool mark : {true, false}) {
            const auto document = load(utf16(text, littleEndian, mark));
            ASSERT_TRUE(document) << littleEndian << mark << format(diagnostics_);
            EXPECT_EQ(document->root().text(), "x");
            EXPECT_EQ(document->root().line(), 2);
        }
    }
}

TEST_F(XmlFile, RefusesAnUnknownEncoding) {
    expectRefused("<?xml version=\"1.0\" encoding=\"KLINGON-1\"?><A/>", 1,
                  "'KLINGON-1' is not known");
}

TEST_F(XmlFile, RefusesHalfAUtf16Character) {
    expectRefused(utf16("<A/>", true, true) + "x", 0, "does not fit its encoding");
}

TEST_F(XmlFile, RefusesInvalidUtf8WithItsLine) {
    expectRefused("<A>\n\n\xE4</A>", 3, "not valid UTF-8");
}

TEST(Utf8, RefusesOverlongSurrogateAndControlCharacters) {
    EXPECT_EQ(toUtf8("<A>\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80</A>").problem, "");
    for (const char* bad :
         {"\xC0\xAF", "\xE0\x80\xAF", "\xF0\x80\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80",
          "\x80", "\xFF", "\xE2\x82", "\x01", "\xEF\xBF\xBF"}) {
        EXPECT_NE(toUtf8(std::string{"<A>"} + bad + "</A>").problem, "") << bad;
    }
    EXPECT_NE(toUtf8(std::string_view{"<A>\0</A>", 8}).problem, "");
}

TEST_F(XmlFile, RefusesADocumentType) {
    expectRefused(
        "<?xml version=\"1.0\"?>\n<!-- <!DOCTYPE in a comment> -->\n"
        "<!DOCTYPE A [<!ENTITY a \"aaaaaaaaaa\">]>\n<A>&a;</A>",
        3, "document type");
}

TEST_F(XmlFile, RefusesADeclarationInsideTheRoot) {
    expectRefused("<A>\n<!ENTITY x SYSTEM \"file:///etc/passwd\">\n</A>", 2, "document type");
}

TEST_F(XmlFile, RefusesASecondRoot) {
    expectRefused("<A/>\n<B/>", 2, "second root");
}

TEST_F(XmlFile, RefusesTextOutsideTheRoot) {
    expectRefused("<!-- -->\nhello<A/>", 2, "text outside");
}

TEST_F(XmlFile, RefusesAnEmptyFile) {
    EXPECT_FALSE(load(""));
    EXPECT_EQ(diagnostics_.errorCount(), 1U);
}

TEST_F(XmlFile, RefusesAFileWithoutElement) {
    EXPECT_FALSE(load("<!-- nothing -->"));
    EXPECT_EQ(diagnostics_.errorCount(), 1U);
}

TEST_F(XmlFile, RefusesAnUnclosedElement) {
    expectRefused("<A>\n<B>\n</A>", 2, "not closed");
}

TEST_F(XmlFile, RefusesDeepNesting) {
    std::string text;
    for (int i = 0; i < 5000; ++i) text += "<A>";
    expectRefused(text, 1, "nested deeper");
}

TEST_F(XmlFile, RefusesADoubledAttribute) {
    expectRefused("<A>\n<B x='1'\n y='2' x='3'/></A>", 3, "is there twice");
}

TEST_F(XmlFile, RefusesACrowdOfAttributes) {
    std::string text = "<A>\n<B";
    for (int i = 0; i < 2'000'000; ++i) text += " a='" + std::to_string(i % 10) + "'";
    expectRefused(text + "/></A>", 2, "too many attributes");
}

TEST_F(XmlFile, RefusesAFileAboveTheCap) {
    EXPECT_FALSE(load("<A>" + std::string(2000, ' ') + "</A>", 1024));
    EXPECT_NE(format(diagnostics_).find("too large"), std::string::npos);
}

TEST_F(XmlFile, SaysWhenThereIsNoFile) {
    EXPECT_FALSE(loadXml(folder_.path() / "missing.xml", MaxMachineFile, diagnostics_));
    EXPECT_NE(format(diagnostics_).find("missing.xml: error: there is no such file"),
              std::string::npos);
}

TEST_F(XmlFile, RefusesAFolder) {
    EXPECT_FALSE(loadXml(folder_.path(), MaxMachineFile, diagnostics_));
    EXPECT_TRUE(diagnostics_.hasErrors());
}

TEST(Schema, ReportsTheLineOfAFault) {
    const char* const schema =
        "<xs:schema xmlns:xs='http://www.w3.org/2001/XMLSchema'><xs:element "
        "name='A'><xs:complexType>"
        "<xs:attribute name='n' type='xs:unsignedByte'/></xs:complexType></xs:element></xs:schema>";
    EXPECT_TRUE(validate("<A n='7'/>", schema).empty());
    const auto messages = validate("<!-- -->\n<A n='x7'/>", schema);
    ASSERT_FALSE(messages.empty());
    EXPECT_EQ(messages.front().line, 2);
    EXPECT_NE(messages.front().text.find("x7"), std::string::npos);
}

}  // namespace
}  // namespace takt::config
