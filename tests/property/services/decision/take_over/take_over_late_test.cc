// The shares of drivers who take over too late, and of drivers who never take over. Both shares
// must equal the scenario's probabilities, within the exact confidence interval of a binomial
// count.
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>
#include <boost/math/special_functions/beta.hpp>

#include "services/decision/take_over/take_over.h"

namespace fogline {
namespace {

constexpr std::int64_t kDraws = 20'000;
constexpr double kMistrust = 1e-3;  // 1 minus the confidence of 99.9 %

struct Interval {
  double low;
  double high;
};

/// The interval of the probabilities that are compatible with `count` events in kDraws draws
/// (Clopper & Pearson 1934).
Interval Confidence(std::int64_t count) {
  const auto k = static_cast<double>(count);
  const auto n = static_cast<double>(kDraws);
  return {.low = count == 0 ? 0.0 : boost::math::ibeta_inv(k, n - k + 1, kMistrust / 2),
          .high = count == kDraws ? 1.0 : boost::math::ibeta_inv(k + 1, n - k, 1 - kMistrust / 2)};
}

void ExpectProbability(std::int64_t count, double probability) {
  const auto [low, high] = Confidence(count);
  EXPECT_LE(low, probability) << count << " of " << kDraws;
  EXPECT_GE(high, probability) << count << " of " << kDraws;
}

Scenario Asking(const TakeOverParameters& time, double lead_s) {
  Scenario scenario;
  scenario.arbitrator.take_over.mode = TakeOverMode::kRequested;
  scenario.arbitrator.take_over.lead_s = lead_s;
  scenario.arbitrator.take_over.time = time;
  return scenario;
}

/// The state `steps` steps after a request in step `request`, if the car does not slow down.
take_over::TakeOverState StateAfter(take_over::TakeOver& take_over, std::int64_t request,
                                    std::int64_t steps) {
  const take_over::TakeOverInputs inputs{.human_wanted = true, .readiness = 1, .speed_mps = 20};
  header_t header{};
  header.step = request + steps;
  return take_over.Step(header, inputs).state;
}

struct Count {
  std::int64_t late = 0;
  std::int64_t absent = 0;
};

Count Ask(const Scenario& scenario) {
  const auto lead =
      static_cast<std::int64_t>(scenario.arbitrator.take_over.lead_s / scenario.step_s + 0.5);
  constexpr std::int64_t kLong = 1'000'000;  // steps: more than a day
  Count count;
  for (std::int64_t request = 0; request < kDraws; ++request) {
    take_over::TakeOver take_over(scenario);
    EXPECT_EQ(StateAfter(take_over, request, 0), take_over::TakeOverState::kDemand);
    if (StateAfter(take_over, request, lead) != take_over::TakeOverState::kMrmComfort) {
      EXPECT_EQ(take_over.outcome().state, take_over::TakeOverState::kHandover);
      continue;
    }
    ++count.late;
    if (StateAfter(take_over, request, kLong) != take_over::TakeOverState::kRecovering)
      ++count.absent;
  }
  return count;
}

TEST(TakeOverLateTest, HappensAsOftenAsTheParameterSaysWhateverTheModel) {
  for (const TakeOverModel model : {TakeOverModel::kLogNormalByLead, TakeOverModel::kSumo}) {
    for (const auto& [late, lead_s] : {std::pair{0.05, 10.0}, {0.01, 12.0}, {0.1, 10.0}}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(model) << ", " << late << ", " << lead_s);
      const Count count = Ask(Asking({.model = model, .late_probability = late}, lead_s));
      ExpectProbability(count.late, late);
      EXPECT_EQ(count.absent, 0);
    }
  }
}

// The model `sumo` draws again if a take-over time is negative. For a lead time of 20 s, 15 % of
// the draws are negative. So with this model more drivers are late than `late_probability` says,
// and the test compares with LateProbability().
TEST(TakeOverLateTest, IsWhatTheDistributionHasOfItForTheLongestRequest) {
  for (const TakeOverModel model : {TakeOverModel::kLogNormalByLead, TakeOverModel::kSumo}) {
    const TakeOverParameters given{.model = model, .late_probability = 0.1};
    ExpectProbability(Ask(Asking(given, 20)).late,
                      models::TakeOverTime(given, 20).LateProbability());
  }
}

TEST(TakeOverLateTest, IsWhatMeanAndDeviationMakeOfItWhereTheyAreGiven) {
  const TakeOverParameters given{.mean_s = 6.75, .std_s = 3.6};  // 15 % take longer than 10 s
  ExpectProbability(Ask(Asking(given, 10)).late, models::TakeOverTime(given, 10).LateProbability());
}

TEST(TakeOverLateTest, IsForeverAsOftenAsTheParameterSays) {
  Scenario scenario = Asking({.mean_s = 2.7, .std_s = 1.45}, 20);
  scenario.arbitrator.take_over.absent_probability = 0.3;
  ExpectProbability(Ask(scenario).absent, 0.3);
}

}  // namespace
}  // namespace fogline
