#include "tools/cli/measures/take_over_text.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fogline::cli {
namespace {

using metrics::TakeOverEnd;

metrics::TakeOverMeasures Taken() {
  return {.outcome = TakeOverEnd::kTakenOver,
          .requested_s = 2,
          .judged_s = 7.25,
          .reaction_time_s = 2.5,
          .speed_at_request_mps = 20,
          .min_ttc_s = 3,
          .automation_drove_s = 2.25,
          .driver_drove_s = 5,
          .sensor_excluded_s = 1};
}

runner::RunResult WithARequest() {
  runner::RunResult result;
  result.take_overs = {Taken(), {.outcome = TakeOverEnd::kWithdrawn, .requested_s = 40}};
  return result;
}

TEST(TakeOverTextTest, TellsNothingWithoutARequestAndAPerson) {
  EXPECT_EQ(TakeOversText({}), "");
  nlohmann::ordered_json json{{"log", "a"}};
  AddTakeOvers({}, json);
  EXPECT_EQ(json.dump(), R"({"log":"a"})");
}

TEST(TakeOverTextTest, HasEveryMeasureInItsJson) {
  nlohmann::ordered_json json;
  AddTakeOvers(WithARequest(), json);
  ASSERT_EQ(json["take_overs"].size(), 2U);
  EXPECT_EQ(json["take_overs"][0].dump(),
            R"({"outcome":"taken_over","requested_s":2.0,"first_movement_time_s":null,)"
            R"("pedal_on_time_s":null,"reaction_time_s":2.5,"take_over_time_s":null,)"
            R"("effective_input_time_s":null,"manoeuvre_time_s":null,"judged_s":7.25,)"
            R"("speed_at_request_mps":20.0,"speed_at_fog_mps":null,"max_deceleration_mps2":null,)"
            R"("mean_deceleration_mps2":null,"max_abs_jerk_1s_mps3":null,"min_ttc_s":3.0,)"
            R"("min_time_gap_s":null,"automation_drove_s":2.25,"sensor_excluded_s":1.0,)"
            R"("driver_drove_s":5.0,"manoeuvre_drove_s":0.0})");
  EXPECT_EQ(json["take_overs"][1]["outcome"], "withdrawn");
  EXPECT_FALSE(json.contains("input_latency"));
}

TEST(TakeOverTextTest, HasTheLatencyOfAPersonsInputs) {
  runner::RunResult result;
  result.input_latency = {.inputs = 9, .p50_us = 10, .p95_us = 20, .max_us = 30};
  nlohmann::ordered_json json;
  AddTakeOvers(result, json);
  EXPECT_EQ(json.dump(), R"({"input_latency":{"inputs":9,"p50_us":10,"p95_us":20,"max_us":30}})");
  EXPECT_EQ(TakeOversText(result),
            "  input_latency_inputs                       9 \n"
            "  input_latency_p50_us                      10 us\n"
            "  input_latency_p95_us                      20 us\n"
            "  input_latency_max_us                      30 us\n");
}

TEST(TakeOverTextTest, ListsTheMeasuresThatHaveAValue) {
  EXPECT_EQ(TakeOversText(WithARequest()),
            "  take-over 1: taken over\n"
            "    requested_s                           2.00 s\n"
            "    reaction_time_s                       2.50 s\n"
            "    judged_s                              7.25 s\n"
            "    speed_at_request_mps                 20.00 m/s\n"
            "    min_ttc_s                             3.00 s\n"
            "    automation_drove_s                    2.25 s\n"
            "    sensor_excluded_s                     1.00 s\n"
            "    driver_drove_s                        5.00 s\n"
            "    manoeuvre_drove_s                        0 s\n"
            "  take-over 2: withdrawn\n"
            "    requested_s                          40.00 s\n"
            "    judged_s                                 0 s\n"
            "    speed_at_request_mps                     0 m/s\n"
            "    automation_drove_s                       0 s\n"
            "    sensor_excluded_s                        0 s\n"
            "    driver_drove_s                           0 s\n"
            "    manoeuvre_drove_s                        0 s\n");
  EXPECT_EQ(TakeOverLine(Taken()),
            "taken over; reaction time 2.50 s; judged interval 7.25 s; "
            "speed at the request 20.00 m/s; smallest TTC 3.00 s; "
            "driving time of the automation 2.25 s; of this with a sensor excluded 1.00 s; "
            "driving time of the driver 5.00 s; driving time of the manoeuvre 0 s");
}

}  // namespace
}  // namespace fogline::cli
