#include "app/view/readable_number.h"

#include <gtest/gtest.h>

#include <limits>

namespace app {
namespace {

TEST(ReadableNumber, HasTheDigitsThatCount)
{
    EXPECT_EQ(readableNumber(0.0), "0");
    EXPECT_EQ(readableNumber(15254.3), "15254");
    EXPECT_EQ(readableNumber(0.83333), "0.8333");
    EXPECT_EQ(readableNumber(-0.02), "-0.02");
    EXPECT_EQ(readableNumber(9.99996), "10");
    EXPECT_EQ(readableNumber(2.0e-4), "0.0002");
}

TEST(ReadableNumber, HasAnExponentWhereItIsVeryLargeOrSmall)
{
    EXPECT_EQ(readableNumber(12345678.0), "1.235e7");
    EXPECT_EQ(readableNumber(-1.0e6), "-1e6");
    EXPECT_EQ(readableNumber(3.5527e-15, 2), "3.6e-15");
    EXPECT_EQ(readableNumber(std::numeric_limits<double>::infinity()), "inf");
}

}  // namespace
}  // namespace app
