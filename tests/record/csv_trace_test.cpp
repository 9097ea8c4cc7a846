#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <takt/record/csv_trace.hpp>

#include "temporary_file.hpp"

namespace takt::record {
namespace {

std::vector<TraceColumn> columns() {
    return {{"cycle", ColumnKind::Integer, {}},
            {"X.set", ColumnKind::Real, {}},
            {"X.state", ColumnKind::Text, {"Disabled", "Standstill"}}};
}

std::array<TraceCell, 3> cells(std::int64_t cycle, double set, std::int64_t state) {
    return {TraceCell{.integer = cycle}, TraceCell{.real = set}, TraceCell{.integer = state}};
}

TEST(CsvTrace, WritesAHeaderAndOneLineForEachRow) {
    const test::TemporaryFile temporary{".csv"};
    OutputFile file{temporary.path()};
    CsvTrace csv{file, columns()};
    csv.take(cells(1, 0.1, 0));
    csv.take(cells(2, -2.5e-7, 1));
    EXPECT_TRUE(csv.finish());
    EXPECT_EQ(temporary.content(), "cycle,X.set,X.state\n1,0.1,Disabled\n2,-2.5e-07,Standstill\n");
}

TEST(CsvTrace, WritesAValueAgainThatDidNotChange) {
    const test::TemporaryFile temporary{".csv"};
    OutputFile file{temporary.path()};
    CsvTrace csv{file, columns()};
    for (int i = 0; i < 2; ++i) csv.take(cells(7, 0.0, 1));
    csv.take(cells(7, -0.0, 1));
    csv.finish();
    EXPECT_EQ(temporary.content(),
              "cycle,X.set,X.state\n7,0,Standstill\n7,0,Standstill\n7,-0,Standstill\n");
}

TEST(CsvTrace, ShowsAStateWithoutNameByItsNumber) {
    const test::TemporaryFile temporary{".csv"};
    OutputFile file{temporary.path()};
    CsvTrace csv{file, columns()};
    csv.take(cells(0, 0.0, 2));
    csv.finish();
    EXPECT_EQ(temporary.content(), "cycle,X.set,X.state\n0,0,2\n");
}

TEST(CsvTrace, KeepsEveryLineOfALongTrace) {
    const test::TemporaryFile temporary{".csv"};
    OutputFile file{temporary.path()};
    CsvTrace csv{file, columns()};
    constexpr std::int64_t Rows = 20000;
    for (std::int64_t i = 0; i < Rows; ++i) csv.take(cells(i, static_cast<double>(i) / 3.0, 0));
    ASSERT_TRUE(csv.finish());
    const std::string text = temporary.content();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), Rows + 1);
    EXPECT_NE(text.find("\n19999,6666.333333333333,Disabled\n"), std::string::npos);
}

TEST(AppendNumber, ReadsBackExactlyForRandomBitPatterns) {
    std::mt19937_64 random{20240607};  // NOLINT(cert-msc51-cpp): a fixed seed is the point
    for (int i = 0; i < 20000; ++i) {
        const auto value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        std::string text;
        appendNumber(text, value);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)),
                  std::bit_cast<std::uint64_t>(value))
            << text;
    }
}

TEST(AppendNumber, WritesEveryNaNTheSameWay) {
    std::string text;
    appendNumber(text, std::numeric_limits<double>::quiet_NaN());
    appendNumber(text, -std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(text, "nannan");
}

TEST(OutputFile, NamesFileAndReasonWhenItCannotBeOpened) {
    try {
        const OutputFile file{"/nonexistent/trace.csv"};
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(),
                     "cannot write /nonexistent/trace.csv: No such file or directory");
    }
}

TEST(OutputFile, SaysThatTheDiskWasFull) {
    OutputFile file{"/dev/full"};
    file.write(std::string(1 << 20, 'x'));
    EXPECT_FALSE(file.flush());
    EXPECT_FALSE(file.ok());
}

}  // namespace
}  // namespace takt::record
