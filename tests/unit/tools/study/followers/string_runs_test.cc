#include "tools/study/followers/string_runs.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/tools/study/few_seeds.h"

namespace fogline {
namespace {

/// The outcome of a string of cars with ACCs, in fog that begins after 20 s. @param more overrides
/// of dense_fog.json
study::StringOutcome RunString(std::vector<std::string> more, int steps = 350) {
  more.insert(more.end(), {"/fog/start_s=20", "/steps=" + std::to_string(steps)});
  const std::array kinds{
      study::StudyCase{.name = "acc", .file = "dense_fog.json", .overrides = std::move(more)}};
  const std::array variants{study::HostVariants().front()};
  return study::RunStrings(test::FewSeeds(1, 2), kinds, variants).front();
}

TEST(StringRunsTest, AmplificationIsACarsBrakingOverThatOfTheCarAhead) {
  const study::StringOutcome string = RunString({});
  ASSERT_EQ(string.cars.size(), study::kStringCars + 1);
  EXPECT_TRUE(string.cars[0].amplification.empty()) << "the host follows no car of the string";
  for (std::size_t place = 1; place <= study::kStringCars; ++place) {
    for (std::size_t seed = 0; seed < 2; ++seed) {
      const double own = string.cars[place].max_deceleration_mps2[seed];
      const double ahead = string.cars[place - 1].max_deceleration_mps2[seed];
      ASSERT_GT(ahead, 0.01);
      EXPECT_EQ(string.cars[place].amplification[seed], own / ahead) << place;
      EXPECT_NE(own, ahead);
    }
  }
}

/// Overrides for a leader that brakes hard, without fog. @param start_s when it begins to brake
std::vector<std::string> HardBraking(double start_s) {
  return {"/lead/profile=emergency_brake",
          "/lead/emergency_brake/start_s=" + std::to_string(start_s),
          "/lead/emergency_brake/deceleration_mps2=6", "/lead/emergency_brake/final_speed_mps=12",
          "/fog/model=none"};
}

TEST(StringRunsTest, MeasuresFromASecondBeforeTheFog) {
  // GIVEN a leader that brakes hard long before the fog, so that every car behind it brakes, too
  const study::StringOutcome braked = RunString(HardBraking(1));
  // THEN the measures show none of this braking
  for (const study::CarInString& car : braked.cars) {
    for (const double braking : car.max_deceleration_mps2) EXPECT_LT(braking, 0.5);
  }
  // BUT the measures show the braking of the host in the last second before 20 s, the time at which
  // the fog would begin. This run ends at 20 s, so it has no later braking.
  const study::StringOutcome brakes = RunString(HardBraking(18), /*steps=*/200);
  for (const double braking : brakes.cars[0].max_deceleration_mps2) EXPECT_GT(braking, 0.5);
}

TEST(StringRunsTest, ACarThatNeverClosesInHasAnInfiniteTimeToCollision) {
  // GIVEN a leader that becomes faster and faster, so that each car is slower than the car ahead
  const study::StringOutcome string = RunString(
      {"/lead/profile=breakpoints",
       R"(/lead/breakpoints=[{"duration_s":8,"speed_mps":20},{"duration_s":35,"speed_mps":34}])",
       "/fog/model=none", "/radar/range_std_m=0", "/radar/range_rate_std_mps=0",
       "/lidar/range_std_m=0"});
  for (std::size_t place = 1; place <= study::kStringCars; ++place) {
    for (const double ttc_s : string.cars[place].min_ttc_s) {
      EXPECT_EQ(ttc_s, std::numeric_limits<double>::infinity()) << place;
    }
  }
}

}  // namespace
}  // namespace fogline
