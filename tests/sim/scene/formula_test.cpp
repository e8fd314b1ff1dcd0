#include "sim/scene/formula.h"

#include <gtest/gtest.h>

#include <array>

namespace sim {
namespace {

TEST(Formula, HasTheValueOfItsTextWithItsNames)
{
    int calls = 0;
    const FormulaNames names{.variables = {"x", "t"},
                             .constants = {{"k", 2.0}},
                             .functions = {{"mass", 0, [&](auto) { return ++calls, 5.0; }}, {"at", 1, [](auto a) { return 10.0 * a[0]; }}}};
    const Formula formula("k*x + sin(pi*t) + mass + at(3)", names);
    EXPECT_EQ(calls, 0);
    EXPECT_NEAR(formula(std::array{1.5, 0.5}), 3.0 + 1.0 + 5.0 + 30.0, 1.0e-12);
    EXPECT_EQ(calls, 1);
    EXPECT_NEAR(Formula("x - t", names)(std::array{1.5, 0.5}), 1.0, 1.0e-15);
    EXPECT_EQ(calls, 1);  // of those that do not name it
}

TEST(Formula, SaysWhatIsWrong)
{
    for (const char* text : {"", "1 +", "speed", "sin(1", "at(1, 2)"})
        EXPECT_THROW(Formula(text, {.functions = {{"at", 1, [](auto) { return 0.0; }}}}), FormulaError) << text;
    EXPECT_THROW(Formula("log(-1)")(), FormulaError);
    EXPECT_THROW(Formula("1/0")(), FormulaError);
}

}  // namespace
}  // namespace sim
