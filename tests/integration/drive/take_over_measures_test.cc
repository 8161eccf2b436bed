// The measures of a take-over by a person, in real processes. take_over_measures.py, which does not
// use Fogline's code, computes the same measures from the raw messages of the log.
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/drive/driven_run.h"

namespace fogline::test {
namespace {

/// Settings that shorten scenario/drive.json to 15 s: the fog begins at 1 s, the person is asked in
/// the fog, and the car ahead brakes. On a busy machine a process may stand still for a while. This
/// must not disturb the test, so an input counts as lost, and the person as absent, only after some
/// seconds.
std::vector<std::string> ShortStory() {
  return {"/person/drives=true",
          "/fog/start_s=1",
          "/fog/duration_s=20",
          "/arbitrator/take_over/recovery_s=4",
          "/health/lost_periods=100",
          "/person/deadman_s=5",
          R"(/lead/breakpoints=[{"duration_s":7,"speed_mps":20},{"duration_s":3,"speed_mps":12}])"};
}

/// The person first moves the brake a little, and answers the request with the button. Then the
/// person brakes with two positions of the pedal, and accelerates.
constexpr const char* kStory =
    "0 0 0 0 1; 7 0 0.02 0 1; 7.5 0 0.05 1 1; 7.8 0 0.3 0 1; 9 0 0.6 0 1; 10 0.4 0 0 1";

/// What take_over_measures.py prints for this log.
nlohmann::json WorkedOut(const std::string& log) {
  const Outcome outcome =
      RunCommand({"python3", "tests/integration/drive/take_over_measures.py", log, "0.1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

nlohmann::json Measured(const std::string& log) {
  const Outcome outcome = RunCommand({Program("fogline"), "metrics", log, "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false).at(0);
}

TEST(TakeOverMeasuresInRealtimeTest, OfAPersonAreThoseThatTheRawMessagesGive) {
  RealtimeRun run(kDriveScenario, 750, 1, ShortStory());
  const Background seat(SeatCommand(run.url(), kStory));
  const nlohmann::json result = run.Finish();
  ASSERT_TRUE(result.is_object());
  const nlohmann::json expected = WorkedOut(run.log());
  const nlohmann::json measured = Measured(run.log());
  ASSERT_EQ(expected.size(), 1U) << result.dump(2);
  ASSERT_EQ(measured["take_overs"].size(), 1U) << measured;
  const nlohmann::json& request = measured["take_overs"][0];
  EXPECT_EQ(request["outcome"], "taken_over");
  for (const auto& [name, value] : expected[0].items()) {
    ASSERT_TRUE(request.contains(name)) << name;
    ASSERT_EQ(request[name].is_null(), value.is_null()) << name << ": " << request[name];
    if (value.is_null()) continue;
    EXPECT_NEAR(request[name], value, 1e-9) << name;
  }
  // The result of the run has the same measures that `fogline metrics` computes from the log.
  EXPECT_EQ(result["take_overs"], measured["take_overs"]);
  // THEN the measures agree with kStory: first the pedal moves a little, then the person presses
  // the button
  const double moved_s = request["first_movement_time_s"];
  const double answered_s = request["reaction_time_s"];
  EXPECT_GT(moved_s, 0);
  EXPECT_GT(answered_s, moved_s);
  EXPECT_GT(request["take_over_time_s"], answered_s);
  EXPECT_GT(request["pedal_on_time_s"], moved_s);
  EXPECT_GT(request["max_deceleration_mps2"], 2.0);
  EXPECT_GT(request["driver_drove_s"], 3.5);
}

}  // namespace
}  // namespace fogline::test
