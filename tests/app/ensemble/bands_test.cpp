// Logs of several runs over time.
#include "app/ensemble/bands.h"

#include <gtest/gtest.h>

#include <cmath>

namespace app::test {
namespace {

Series seriesOf(std::vector<double> times, std::vector<double> values)
{
    Series series;
    series.name = "probes.csv";
    series.columns = {"time_s", "height [cm]"};
    series.rows = times.size();
    series.times = times;
    series.values = {{"time_s", std::move(times)}, {"height [cm]", std::move(values)}};
    return series;
}

TEST(Bands, AreTakenAtTheTimesOfTheFirstRunAsFarAsAllHaveCome)
{
    // One run has steps of its own, and ends earlier.
    const Bands bands = bandsOf({seriesOf({0.0, 1.0, 2.0, 3.0}, {0.0, 1.0, 2.0, 3.0}), seriesOf({0.0, 0.5, 2.0}, {2.0, 2.0, 5.0})});
    EXPECT_EQ(bands.log, "probes");
    EXPECT_EQ(bands.times, (std::vector{0.0, 1.0, 2.0}));
    const Band* band = bands.find("height [cm]");
    ASSERT_NE(band, nullptr);
    EXPECT_EQ(bands.find("time_s"), nullptr);
    EXPECT_DOUBLE_EQ(band->at[0].mean, 1.0);
    EXPECT_DOUBLE_EQ(band->at[1].mean, 2.0) << "1 and, a third of the way from 2 to 5, 3";
    EXPECT_DOUBLE_EQ(band->at[2].mean, 3.5);
    EXPECT_DOUBLE_EQ(band->at[1].deviation, std::sqrt(2.0));
    EXPECT_EQ(band->at[1].lowest, 1.0);
    EXPECT_DOUBLE_EQ(band->at[1].highest, 3.0);
    EXPECT_EQ(placeOfMean(bands, "height [cm]"), 2u);
}

TEST(Bands, EmptyCellsStayEmpty)
{
    const Bands bands = bandsOf({seriesOf({0.0, 1.0}, {kNothing, 1.0}), seriesOf({0.0, 1.0}, {kNothing, 3.0})});
    EXPECT_EQ(bandsText(bands), "time_s,height [cm] mean,height [cm] deviation,height [cm] lowest,height [cm] highest\n0,,,,\n1,2,1.41421356,1,3\n");
}

}  // namespace
}  // namespace app::test
