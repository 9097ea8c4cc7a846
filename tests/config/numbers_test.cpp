#include "numbers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <limits>
#include <string>

#include "names.hpp"
#include "quantity.hpp"

namespace takt::config {
namespace {

std::optional<Quantity> quantity(std::string_view text, Dimension dimension) {
    std::string problem;
    return parseQuantity(text, dimension, problem);
}

std::string problemOf(std::string_view text, Dimension dimension) {
    std::string problem;
    EXPECT_FALSE(parseQuantity(text, dimension, problem)) << text;
    return problem;
}

TEST(Integer, TakesDecimalAndBothHexadecimalForms) {
    EXPECT_EQ(parseInteger("42"), 42);
    EXPECT_EQ(parseInteger("-7"), -7);
    EXPECT_EQ(parseInteger("+7"), 7);
    EXPECT_EQ(parseInteger("0x1A00"), 0x1A00);
    EXPECT_EQ(parseInteger("#x1a00"), 0x1A00);
    EXPECT_EQ(parseInteger("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
}

TEST(Integer, RefusesWhatIsNotWhollyANumber) {
    for (const char* text : {"", " ", "12abc", "1,5", "1.0", "0x", "#x", "0xG", "--1", "+-1", "1 2",
                             "nan", "9223372036854775808", "#xFFFFFFFFFFFFFFFF", "#x-1", "0x+1"}) {
        EXPECT_FALSE(parseInteger(text)) << '"' << text << '"';
    }
}

TEST(DecimalNumber, IsExactWhereSixtyFourBitsHoldIt) {
    NumberFault fault{};
    const auto number = parseDecimal("-0.250", fault);
    ASSERT_TRUE(number && number->exact);
    EXPECT_EQ(number->exact->numerator, -1);
    EXPECT_EQ(number->exact->denominator, 4);
    EXPECT_EQ(number->value, -0.25);
    const auto scaled = parseDecimal("1.5e3", fault);
    ASSERT_TRUE(scaled && scaled->exact);
    EXPECT_EQ(scaled->exact->numerator, 1500);
    EXPECT_EQ(scaled->exact->denominator, 1);
    const auto zeros = parseDecimal("1.5000000000000000000000000000000", fault);
    ASSERT_TRUE(zeros && zeros->exact);
    EXPECT_EQ(zeros->exact->numerator, 3);
    EXPECT_EQ(zeros->exact->denominator, 2);
}

TEST(DecimalNumber, KeepsOnlyTheRoundedValueOfTooManyDigits) {
    NumberFault fault{};
    const auto number = parseDecimal("3.14159265358979323846264338327950288", fault);
    ASSERT_TRUE(number);
    EXPECT_FALSE(number->exact);
    EXPECT_EQ(number->value, 3.14159265358979323846);
}

TEST(DecimalNumber, TellsOverflowFromNonsense) {
    NumberFault fault{};
    for (const char* text : {"1e999", "-1e999", "1e-999", "1e99999999999"}) {
        EXPECT_FALSE(parseDecimal(text, fault)) << text;
        EXPECT_EQ(fault, NumberFault::OutOfRange) << text;
    }
    for (const char* text :
         {"", "nan", "inf", "infinity", "0x10", "1,5", ".5", "1.", "1e", "e5", "1.5.2", " 1"}) {
        EXPECT_FALSE(parseDecimal(text, fault)) << text;
        EXPECT_EQ(fault, NumberFault::NotANumber) << text;
    }
}

TEST(DecimalNumber, DoesNotListenToTheLocale) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    NumberFault fault{};
    EXPECT_FALSE(parseDecimal("1,5", fault));
    EXPECT_EQ(parseDecimal("1.5", fault)->value, 1.5);
    std::setlocale(LC_ALL, before.c_str());
}

TEST(RatioText, TakesPositiveRatiosOnly) {
    EXPECT_EQ(parseRatio("10/4")->numerator, 5);
    EXPECT_EQ(parseRatio("10/4")->denominator, 2);
    EXPECT_EQ(parseRatio("1 : 10")->denominator, 10);
    EXPECT_EQ(parseRatio("2.5")->numerator, 5);
    for (const char* text :
         {"0/0", "1/0", "0/1", "-1/2", "1/2/3", "", "/", "a/b", "1e300/1", "4294967296/1"}) {
        EXPECT_FALSE(parseRatio(text)) << text;
    }
}

TEST(QuantityText, ConvertsExactlyToTheBaseUnit) {
    EXPECT_EQ(quantity("0.1 mm", Dimension::Length)->value, 0.1);
    EXPECT_EQ(quantity("1.2 m", Dimension::Length)->value, 1200.0);
    EXPECT_EQ(quantity("60 m/min", Dimension::LinearVelocity)->value, 1000.0);
    EXPECT_EQ(quantity("3000 rpm", Dimension::MotorSpeed)->value, 50.0);
    EXPECT_EQ(quantity("10 rpm", Dimension::AngularVelocity)->value, 60.0);
    EXPECT_EQ(quantity("1.5 kg cm^2", Dimension::Inertia)->value, 1.5e-4);
    EXPECT_EQ(quantity("50 %", Dimension::Share)->value, 0.5);
    EXPECT_EQ(quantity("0.125 ms", Dimension::Time)->value, 125000.0);
    const auto third = quantity("20 mm/min", Dimension::LinearVelocity);
    EXPECT_EQ(third->exact->numerator, 1);
    EXPECT_EQ(third->exact->denominator, 3);
}

TEST(QuantityText, TakesEverySpellingOfAUnit) {
    EXPECT_EQ(quantity("2000mm/s²", Dimension::LinearAcceleration)->value, 2000.0);
    EXPECT_EQ(quantity("  5 mm/s³ ", Dimension::LinearJerk)->value, 5.0);
    EXPECT_EQ(quantity("30 µs", Dimension::Time)->value, 30000.0);
    EXPECT_EQ(quantity("30 μs", Dimension::Time)->value, 30000.0);
    EXPECT_EQ(quantity("90°", Dimension::Angle)->value, 90.0);
    EXPECT_EQ(quantity("1 kg·m²", Dimension::Inertia)->value, 1.0);
}

TEST(QuantityText, NamesWhatIsWrong) {
    EXPECT_EQ(problemOf("500", Dimension::LinearVelocity), "the unit is missing");
    EXPECT_EQ(problemOf("5 inch", Dimension::Length), "the unit 'inch' is not known here");
    EXPECT_EQ(problemOf("5 mm/s", Dimension::Length), "the unit 'mm/s' is not known here");
    EXPECT_EQ(problemOf("nan mm", Dimension::Length), "this is not a number with a unit");
    EXPECT_EQ(problemOf("1,5 mm", Dimension::Length), "the unit ',5 mm' is not known here");
    EXPECT_EQ(problemOf("1e999 mm", Dimension::Length), "the number is too large or too small");
    EXPECT_EQ(problemOf("1e308 m", Dimension::Length), "the number is too large");
}

TEST(NearestName, FindsATypoAndStaysSilentOtherwise) {
    const std::array<std::string, 3> known{"Limits", "Homing", "Scaling"};
    EXPECT_EQ(nearestName("Limit", known), "Limits");
    EXPECT_EQ(nearestName("limits", known), "Limits");
    EXPECT_EQ(nearestName("Hoimng", known), "Homing");
    EXPECT_EQ(nearestName("Gearbox", known), "");
    EXPECT_EQ(nearestName(std::string(100'000, 'x'), known), "");
}

}  // namespace
}  // namespace takt::config
