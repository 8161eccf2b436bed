// The measures and the log of events must count the same transfers.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "services/decision/policies/policies.h"
#include "services/decision/take_over/take_over_log.h"
#include "services/host_modes.h"
#include "services/metrics/run_metrics.h"

namespace fogline {
namespace {

struct Counted {
  std::int64_t by_measures = 0;
  std::optional<double> min_dwell_s;
  std::vector<std::int64_t> by_events;  // steps
  bool shared = false;                  // whether lambda_human was below 1/2 in a mode of the human
};

Counted CountTransfers(const Scenario& scenario) {
  Counted counted;
  metrics::MetricsAccumulator measures(scenario);
  take_over::TakeOverLog log;
  closed_loop::ClosedLoop(scenario).Run(0, [&](const closed_loop::StepView& step) {
    measures.Add(step.ToSample());
    log.Add(step.host, step.driver.acceleration_mps2);
    counted.shared |= HumanDrives(step.host.mode) && !HumanDrives(step.host.lambda_human);
  });
  for (const take_over::TakeOverEntry& entry : log.entries()) {
    if (entry.transfer) counted.by_events.push_back(entry.step);
  }
  counted.by_measures = measures.Result().transfers;
  counted.min_dwell_s = measures.Result().min_dwell_s;
  return counted;
}

/// The shortest time between two transfers in the log of events.
std::optional<double> MinDwell_s(const Counted& counted, double step_s) {
  std::optional<double> least;
  for (std::size_t i = 1; i < counted.by_events.size(); ++i) {
    const double dwell_s =
        static_cast<double>(counted.by_events[i] - counted.by_events[i - 1]) * step_s;
    if (!least || dwell_s < *least) least = dwell_s;
  }
  return least;
}

TEST(TransfersTest, AreCountedAlikeByMeasuresAndEventsUnderEveryPolicyProfileAndModeOfTakeOver) {
  std::size_t transfers = 0;
  int shared = 0;
  for (const policies::PolicyRow& row : policies::Policies()) {
    for (const std::string_view profile : ChoiceNames<TransferProfile>::kNames) {
      for (const std::string mode : {"instant", "requested"}) {
        for (const std::string file : {"paper", "dense_fog"}) {
          SCOPED_TRACE(testing::Message()
                       << row.name << ' ' << profile << ' ' << mode << ' ' << file);
          const Scenario scenario = LoadScenario(
              std::string(FOGLINE_SOURCE_DIR) + "/scenario/" + file + ".json",
              {"/arbitrator/policy=" + std::string(row.name),
               "/arbitrator/transfer/profile=" + std::string(profile),
               "/arbitrator/transfer/duration_s=1.3", "/arbitrator/take_over/mode=" + mode});
          const Counted counted = CountTransfers(scenario);
          EXPECT_EQ(counted.by_measures, std::ssize(counted.by_events));
          // Measures and events must also have the transfers in the same steps. The measures do not
          // list the steps, so the test compares the shortest time between two transfers.
          const std::optional<double> dwell_s = MinDwell_s(counted, scenario.step_s);
          ASSERT_EQ(counted.min_dwell_s.has_value(), dwell_s.has_value());
          EXPECT_NEAR(counted.min_dwell_s.value_or(0), dwell_s.value_or(0), 1e-6)
              << "rounding of sums";
          transfers += counted.by_events.size();
          if (counted.shared) ++shared;
        }
      }
    }
  }
  EXPECT_GT(transfers, 80U) << "there is something to count";
  EXPECT_GT(shared, 8) << "and modes of the driver's that are no transfer";
}

}  // namespace
}  // namespace fogline
