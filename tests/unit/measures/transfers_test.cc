// What counts as a transfer: the same for measures and for the log of events.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "scenario/loader.h"
#include "services/arbitrator/take_over_log.h"
#include "services/closed_loop/closed_loop.h"
#include "services/measures/measures.h"
#include "services/minimal_risk/modes.h"
#include "services/policies/policies.h"

namespace fogline {
namespace {

struct Counted {
  std::int64_t by_measures;
  std::int64_t by_events;
};

Counted CountTransfers(const Scenario& scenario) {
  MeasureAccumulator measures(scenario);
  TakeOverLog log;
  ClosedLoop(scenario).Run(0, [&](const StepView& step) {
    measures.Add(step.ToSample());
    log.Add(step.host);
  });
  const auto is_transfer = [](const TakeOverEntry& entry) {
    return HumanDrives(entry.from) != HumanDrives(entry.to);
  };
  return {.by_measures = measures.Result().transfers,
          .by_events = std::ranges::count_if(log.entries(), is_transfer)};
}

TEST(TransfersTest, AreCountedAlikeByMeasuresAndEventsUnderEveryPolicyAndProfile) {
  std::int64_t all = 0;
  for (const PolicyRow& row : Policies()) {
    for (const std::string profile : {"step", "linear"}) {
      for (const std::string file : {"paper", "dense_fog"}) {
        const Counted counted = CountTransfers(
            LoadScenario(std::string(FOGLINE_SOURCE_DIR) + "/scenario/" + file + ".json",
                         {"/arbitrator/policy=" + std::string(row.name),
                          "/arbitrator/transfer/profile=" + profile}));
        EXPECT_EQ(counted.by_measures, counted.by_events)
            << row.name << ' ' << profile << ' ' << file;
        all += counted.by_events;
      }
    }
  }
  EXPECT_GT(all, 20) << "there is something to count";
}

}  // namespace
}  // namespace fogline
