#include <gtest/gtest.h>

#include <takt/config/diagnostics.hpp>

namespace takt::config {
namespace {

TEST(Diagnostics, PrintsFileLineWhatAllowedAndRemedy) {
    Diagnostics diagnostics;
    diagnostics.error({"machine.xml", 40}, "the unit is missing", "mm, m", "add it");
    diagnostics.warning({"machine.xml", 0}, "short");
    EXPECT_EQ(format(diagnostics),
              "machine.xml:40: error: the unit is missing; allowed: mm, m; do: add it\n"
              "machine.xml: warning: short\n");
}

TEST(Diagnostics, SortsByFileThenLineAndKeepsTheOrderOfOneLine) {
    Diagnostics diagnostics;
    diagnostics.error({"b.xml", 1}, "five");
    diagnostics.error({"a.xml", 10}, "three");
    diagnostics.error({"a.xml", 10}, "four");
    diagnostics.error({"a.xml", 9}, "two");
    diagnostics.error({"a.xml", 0}, "one");
    diagnostics.sort();
    std::string order;
    for (const Diagnostic& item : diagnostics.items()) order += item.what + " ";
    EXPECT_EQ(order, "one two three four five ");
}

TEST(Diagnostics, CountsErrorsButNotNotes) {
    Diagnostics diagnostics;
    diagnostics.note({"a.xml", 1}, "by the way");
    EXPECT_FALSE(diagnostics.hasErrors());
    diagnostics.warning({"a.xml", 1}, "hm");
    EXPECT_FALSE(diagnostics.hasErrors());
    diagnostics.error({"a.xml", 1}, "no");
    EXPECT_TRUE(diagnostics.hasErrors());
    EXPECT_EQ(diagnostics.warningCount(), 1U);
}

TEST(Diagnostics, KeepsABoundedNumber) {
    Diagnostics diagnostics;
    for (int i = 0; i < 1500; ++i) diagnostics.error({"a.xml", i}, "again");
    EXPECT_EQ(diagnostics.items().size(), Diagnostics::MaxKept);
    EXPECT_EQ(diagnostics.errorCount(), 1500U);
    EXPECT_NE(format(diagnostics).find("… and 500 more\n"), std::string::npos);
}

}  // namespace
}  // namespace takt::config
