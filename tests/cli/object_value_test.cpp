#include "object_value.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace takt::cli {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using wire::DataType;

std::vector<int> bytesOf(const core::ObjectValue& value) {
    return {value.bytes.begin(), value.bytes.begin() + value.size};
}

TEST(ObjectAddress, TakesIndexAndSubIndexDecimalOrHexadecimal) {
    const auto address = parseAddress("0x1018:0x04");
    EXPECT_EQ(address.index, 0x1018);
    EXPECT_EQ(address.subindex, 4);
    EXPECT_EQ(parseAddress("24676").index, 0x6064);
    EXPECT_EQ(parseAddress("0x6064").subindex, 0);
}

TEST(ObjectAddress, RefusesWhatIsNoObject) {
    for (const char* text :
         {"", "x", "0x10000", "0x1018:", "0x1018:256", "6064h", "0x1018:1:2", "-1"}) {
        EXPECT_THAT([text] { static_cast<void>(parseAddress(text)); },
                    ThrowsMessage<std::runtime_error>(HasSubstr("INDEX:SUB")))
            << text;
    }
}

TEST(ObjectValue, PutsNumbersIntoLittleEndianBytes) {
    EXPECT_EQ(bytesOf(parseValue("4660", DataType::Unsigned16)), (std::vector<int>{0x34, 0x12}));
    EXPECT_EQ(bytesOf(parseValue("-2", DataType::Integer32)),
              (std::vector<int>{0xFE, 0xFF, 0xFF, 0xFF}));
    EXPECT_EQ(bytesOf(parseValue("0xFF", DataType::Integer8)), (std::vector<int>{0xFF}));
    EXPECT_EQ(bytesOf(parseValue("1", DataType::Boolean)), (std::vector<int>{1}));
    EXPECT_EQ(bytesOf(parseValue("1.5", DataType::Real32)), (std::vector<int>{0, 0, 0xC0, 0x3F}));
    EXPECT_EQ(bytesOf(parseValue("18446744073709551615", DataType::Unsigned64)),
              std::vector<int>(8, 0xFF));
    EXPECT_EQ(bytesOf(parseValue("ab", DataType::VisibleString)), (std::vector<int>{'a', 'b'}));
}

TEST(ObjectValue, TakesTheWholeRangeOfATypeAndNothingBeyond) {
    EXPECT_EQ(showValue(parseValue("-128", DataType::Integer8), DataType::Integer8), "-128");
    EXPECT_EQ(showValue(parseValue("127", DataType::Integer8), DataType::Integer8), "127");
    EXPECT_EQ(
        showValue(parseValue("-9223372036854775808", DataType::Integer64), DataType::Integer64),
        "-9223372036854775808");
    EXPECT_THROW(static_cast<void>(parseValue("-129", DataType::Integer8)), std::runtime_error);
    EXPECT_THROW(static_cast<void>(parseValue("128", DataType::Integer8)), std::runtime_error);
    EXPECT_THROW(static_cast<void>(parseValue("256", DataType::Unsigned8)), std::runtime_error);
    EXPECT_THROW(static_cast<void>(parseValue("-1", DataType::Unsigned8)), std::runtime_error);
    EXPECT_THROW(static_cast<void>(parseValue("2", DataType::Boolean)), std::runtime_error);
    EXPECT_THROW(static_cast<void>(parseValue("18446744073709551616", DataType::Unsigned64)),
                 std::runtime_error);
}

TEST(ObjectValue, RefusesWhatIsNoNumber) {
    for (const char* text : {"", "-", "0x", "1 ", " 1", "1a", "--1", "1.5"}) {
        EXPECT_THROW(static_cast<void>(parseValue(text, DataType::Integer16)), std::runtime_error)
            << text;
    }
    EXPECT_THROW(static_cast<void>(parseValue("one", DataType::Real64)), std::runtime_error);
    EXPECT_THROW(static_cast<void>(parseValue("123456789", DataType::VisibleString)),
                 std::runtime_error);
}

TEST(ObjectValue, ShowsWhatADeviceSent) {
    core::ObjectValue value{{0xFE, 0xFF, 0, 0, 0, 0, 0, 0}, 2};
    EXPECT_EQ(showValue(value, DataType::Integer16), "-2");
    EXPECT_EQ(showValue(value, DataType::Unsigned16), "65534");
    EXPECT_EQ(showHex(value), "0xFFFE");
    EXPECT_EQ(showValue(value, DataType::OctetString), "FE FF");
    value = {{'C', 'D', '\x1B', 0, 'x', 0, 0, 0}, 5};
    EXPECT_EQ(showValue(value, DataType::VisibleString), "CD?") << "nothing that steers a terminal";
}

TEST(ObjectType, NamesTheTypesThatThereAre) {
    EXPECT_EQ(parseType("int16"), DataType::Integer16);
    EXPECT_THAT([] { static_cast<void>(parseType("word")); },
                ThrowsMessage<std::runtime_error>(HasSubstr("uint8, uint16, uint32")));
}

}  // namespace
}  // namespace takt::cli
