#include "tools/export/take_over_csv.h"

#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using metrics::TakeOverEnd;

constexpr const char* kHeader =
    "log,seed,request,outcome,requested_s,first_movement_time_s,pedal_on_time_s,reaction_time_s,"
    "take_over_time_s,effective_input_time_s,manoeuvre_time_s,judged_s,speed_at_request_mps,"
    "speed_at_fog_mps,max_deceleration_mps2,mean_deceleration_mps2,max_abs_jerk_1s_mps3,min_ttc_s,"
    "min_time_gap_s,automation_drove_s,sensor_excluded_s,driver_drove_s,manoeuvre_drove_s,"
    "input_latency_inputs,input_latency_p50_us,input_latency_p95_us,"
    "input_latency_max_us\n";

class TakeOverCsvTest : public testing::Test {
 protected:
  std::string Written(const std::vector<exports::TakeOverRun>& runs) const {
    exports::WriteTakeOverCsv(runs, file_);
    return Content(file_);
  }
  const ScratchFolder folder_;
  const std::string file_ = folder_.File("take-overs.csv");
};

TEST_F(TakeOverCsvTest, HasOnlyItsHeaderWithoutRequests) {
  EXPECT_EQ(Written({}), kHeader);
  EXPECT_EQ(Written({{.log = "a.lcm", .seed = 1, .take_overs = {}, .input_latency = {}}}), kHeader);
}

TEST_F(TakeOverCsvTest, HasALineForEachRequest) {
  exports::TakeOverRun run{.log = "a.lcm", .seed = 3, .take_overs = {}, .input_latency = {}};
  run.take_overs.push_back({.outcome = TakeOverEnd::kTakenOver,
                            .requested_s = 1.5,
                            .judged_s = 7,
                            .pedal_on_time_s = 0.75,
                            .reaction_time_s = 0.1,
                            .speed_at_request_mps = 20,
                            .automation_drove_s = 2,
                            .driver_drove_s = 5,
                            .sensor_excluded_s = 1});
  run.take_overs.push_back({.outcome = TakeOverEnd::kMinimalRisk, .requested_s = 20});
  exports::TakeOverRun person{.log = "b.lcm", .seed = 4, .take_overs = {}, .input_latency = {}};
  person.take_overs.push_back({.requested_s = 2});
  person.input_latency = {.inputs = 9, .p50_us = 10, .p95_us = 20, .max_us = 30};
  EXPECT_EQ(Written({run, person}),
            std::string(kHeader) +
                "a.lcm,3,1,taken_over,1.5,,0.75,0.1,,,,7,20,,,,,,,2,1,5,0,,,,\n"
                "a.lcm,3,2,minimal_risk,20,,,,,,,0,0,,,,,,,0,0,0,0,,,,\n"
                "b.lcm,4,1,open,2,,,,,,,0,0,,,,,,,0,0,0,0,9,10,20,30\n");
}

TEST_F(TakeOverCsvTest, HasALineForRequestsWithUnknownMeasures) {
  const exports::TakeOverRun run{.log = "a.lcm",
                                 .seed = 3,
                                 .take_overs = {{.requested_s = 20}},
                                 .unknown = true,
                                 .input_latency = {}};
  EXPECT_EQ(Written({run}), std::string(kHeader) +
                                "a.lcm,3,,unknown,,,,,,,,,,,,,,,,,,,,,,,\n"
                                "a.lcm,3,1,open,20,,,,,,,0,0,,,,,,,0,0,0,0,,,,\n");
}

TEST_F(TakeOverCsvTest, QuotesTheNameOfALogWithACommaOrAQuote) {
  exports::TakeOverRun run{
      .log = "a,\"b\".lcm", .seed = 1, .take_overs = {{}}, .input_latency = {}};
  EXPECT_THAT(Written({run}), testing::HasSubstr("\n\"a,\"\"b\"\".lcm\",1,1,open,0,"));
}

TEST_F(TakeOverCsvTest, IsKnownByItsBeginning) {
  Written({});
  EXPECT_TRUE(exports::IsTakeOverCsv(file_));
  std::ofstream(file_) << "log,seed\n";
  EXPECT_FALSE(exports::IsTakeOverCsv(file_));
  EXPECT_FALSE(exports::IsTakeOverCsv(folder_.File("none")));
}

}  // namespace
}  // namespace fogline::test
