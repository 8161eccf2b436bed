#include "services/metrics/event_share.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(ClopperPearsonTest, MeetsTheClosedFormsAtTheEnds) {
  // If the true share is p, the probability of no event in n trials is (1 - p)^n, and the
  // probability of n events is p^n. At the bound of the share, this probability is 2.5 %.
  const metrics::EventShare none = metrics::ClopperPearson(0, 10);
  EXPECT_EQ(none.lower, 0);
  EXPECT_NEAR(none.upper, 1 - std::pow(0.025, 0.1), 1e-12);
  const metrics::EventShare all = metrics::ClopperPearson(10, 10);
  EXPECT_NEAR(all.lower, std::pow(0.025, 0.1), 1e-12);
  EXPECT_EQ(all.upper, 1);
}

TEST(ClopperPearsonTest, MeetsTheTables) {
  const metrics::EventShare few = metrics::ClopperPearson(3, 10);
  EXPECT_EQ(few.share, 0.3);
  EXPECT_NEAR(few.lower, 0.06674, 1e-5);
  EXPECT_NEAR(few.upper, 0.65245, 1e-5);
}

TEST(ClopperPearsonTest, BoundsAreWhereTheBinomialTailsAreHalfOfWhatIsLeftOut) {
  const metrics::EventShare share = metrics::ClopperPearson(1, 3);
  // One of three trials has an event. One tail is the probability of at least 1 event in 3 trials
  // if the true share is the lower bound. The other tail is the probability of at most 1 event if
  // the true share is the upper bound. Each tail must be 2.5 %.
  const double lower_tail = 1 - std::pow(1 - share.lower, 3);
  const double q = 1 - share.upper;
  const double upper_tail = q * q * q + 3 * share.upper * q * q;
  EXPECT_NEAR(lower_tail, 0.025, 1e-12);
  EXPECT_NEAR(upper_tail, 0.025, 1e-12);
}

TEST(ClopperPearsonTest, MoreConfidenceIsWider) {
  const metrics::EventShare narrow = metrics::ClopperPearson(5, 50, 0.9);
  const metrics::EventShare wide = metrics::ClopperPearson(5, 50, 0.99);
  EXPECT_LT(wide.lower, narrow.lower);
  EXPECT_GT(wide.upper, narrow.upper);
}

TEST(ClopperPearsonTest, RefusesWhatIsNoShare) {
  EXPECT_THROW(metrics::ClopperPearson(-1, 3), std::invalid_argument);
  EXPECT_THROW(metrics::ClopperPearson(4, 3), std::invalid_argument);
  EXPECT_THROW(metrics::ClopperPearson(0, 0), std::invalid_argument);
  EXPECT_THROW(metrics::ClopperPearson(0, 3, 1), std::invalid_argument);
}

}  // namespace
}  // namespace fogline
