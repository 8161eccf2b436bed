#include "services/models/driver/take_over_time.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(TakeOverTimeTest, KnowsHowOftenALogNormalDriverIsLate) {
  // The time has a mean of 2.7 s and a standard deviation of 1.45 s. So its logarithm has the
  // variance ln 1.2884 = 0.2534 = 0.5034^2 and the mean 0.9933 - 0.1267 = 0.8666. 95 % of the times
  // are below e^(0.8666 + 1.6449 * 0.5034) = 5.445 s.
  EXPECT_NEAR(models::TakeOverTime({}, 5.445).LateProbability(), 0.05, 5e-4);
  EXPECT_NEAR(models::TakeOverTime({}, std::exp(0.8666)).LateProbability(), 0.5, 5e-4);
}

TEST(TakeOverTimeTest, IsLateAsOftenAsAskedFor) {
  for (const double p : {0.01, 0.05, 0.15}) {
    for (const double lead_s : {2.0, 5.0, 8.0}) {
      const TakeOverParameters by_lead{.model = TakeOverModel::kLogNormalByLead,
                                       .late_probability = p};
      EXPECT_NEAR(models::TakeOverTime(by_lead, lead_s).LateProbability(), p, 1e-12);
      const TakeOverParameters sumo{.model = TakeOverModel::kSumo, .late_probability = p};
      EXPECT_NEAR(models::TakeOverTime(sumo, lead_s).LateProbability(), p, 0.01 * p) << lead_s;
    }
  }
}

TEST(TakeOverTimeTest, HasSumosNumbersForTenSecondsAndFivePercent) {
  // The time has a mean of 6.325 s and a standard deviation of 2.234 s (SUMO's table: 2.233). A
  // drawn time is late, that is above 10 s, if its standard normal number is above 1.645. For
  // example, the normal number 1 gives 8.559 s.
  const models::TakeOverTime sumo({.model = TakeOverModel::kSumo}, 10);
  const Random random(5, Stream::kTakeOver);
  for (std::int64_t step = 0; step < 20; ++step) {
    const double normal = random.Normal2(step, 0)[0];
    EXPECT_NEAR(sumo.Draw(random, step), 6.325 + 2.234 * normal, 2e-3) << step;
  }
}

TEST(TakeOverTimeTest, OverdrawsSumosPromiseForLongLeadTimes) {
  // For a lead time of 60 s the mean is 15.49 s and the standard deviation 27.06 s. SUMO repeats
  // the 28 % of draws that are negative. So more than the promised 5 % are late.
  const models::TakeOverTime sumo({.model = TakeOverModel::kSumo}, 60);
  EXPECT_NEAR(sumo.LateProbability(), 0.05 / 0.7165, 1e-4);
}

TEST(TakeOverTimeTest, RefusesWhatNoDistributionHas) {
  const auto by_lead = [](double p) {
    return TakeOverParameters{.model = TakeOverModel::kLogNormalByLead, .late_probability = p};
  };
  EXPECT_THROW(models::TakeOverTime({}, 0), std::invalid_argument);
  EXPECT_THROW(models::TakeOverTime({.mean_s = 0}, 5), std::invalid_argument);
  EXPECT_THROW(models::TakeOverTime(by_lead(0), 5), std::invalid_argument);
  EXPECT_THROW(models::TakeOverTime(by_lead(0.5), 5), std::invalid_argument);
  EXPECT_NO_THROW(models::TakeOverTime(by_lead(0.199), 5));
  EXPECT_THROW(models::TakeOverTime(by_lead(0.20), 5), std::invalid_argument);
  EXPECT_THROW(models::TakeOverTime(by_lead(0.05), 61), std::invalid_argument);
}

// 95 % of drivers have taken over after 5.44 s (log-normal with mean 2.7 s and deviation 1.45 s).
// After the lead time, all drivers except the late ones have taken over.
TEST(TakeOverTimeTest, QuantilesAreThoseOfTheDistribution) {
  EXPECT_NEAR(models::TakeOverTime({}, 10).Quantile(0.95), 5.44, 0.005);
  for (const TakeOverModel model :
       {TakeOverModel::kLogNormal, TakeOverModel::kLogNormalByLead, TakeOverModel::kSumo}) {
    const models::TakeOverTime time({.model = model}, 8);
    EXPECT_NEAR(time.Quantile(1 - time.LateProbability()), 8, 1e-9);
  }
}

}  // namespace
}  // namespace fogline
