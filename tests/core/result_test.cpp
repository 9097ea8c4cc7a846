#include <gmock/gmock.h>

#include <cstdint>
#include <takt/core/result.hpp>

namespace {

enum class Problem : std::uint8_t { None, Bad };
using takt::core::Result;

TEST(Result, HoldsAValueOrAnError) {
    const Result<int, Problem> good{42};
    ASSERT_TRUE(good.ok());
    EXPECT_EQ(good.value(), 42);
    const Result<int, Problem> bad{Problem::Bad};
    ASSERT_FALSE(bad.ok());
    EXPECT_EQ(bad.error(), Problem::Bad);
}

TEST(Result, CostsNoMoreThanValueAndFlag) {
    static_assert(sizeof(Result<std::uint32_t, Problem>) == 2 * sizeof(std::uint32_t));
    static_assert(std::is_trivially_copyable_v<Result<int, Problem>>);
}

}  // namespace
