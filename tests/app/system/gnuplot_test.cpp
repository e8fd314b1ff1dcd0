#include "app/system/gnuplot.h"

#include <gtest/gtest.h>

namespace app::test {
namespace {

TEST(GnuplotUnit, RaisesExponents)
{
    EXPECT_EQ(gnuplotUnit("cm"), "'[cm]'");
    EXPECT_EQ(gnuplotUnit("dyn/cm^2"), "'[dyn/cm^{2}]'");
    EXPECT_EQ(gnuplotUnit("10^-12 m^2 s"), "'[10^{-12} m^{2} s]'");
    EXPECT_EQ(gnuplotUnit(""), "'[]'");
}

TEST(GnuplotUnit, LeavesOtherSignsAsTheyAre)
{
    EXPECT_EQ(gnuplotUnit("a_b{c}"), "'[a\\_b\\{c\\}]'");
    EXPECT_EQ(gnuplotUnit("x^y"), "'[x^y]'");
    EXPECT_EQ(gnuplotUnit("feet'"), "'[feet'']'");
}

}  // namespace
}  // namespace app::test
