#include "tools/replay/difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "services/runtime/wire/wire.h"

namespace fogline::replay {

void PrintTo(const Difference& difference, std::ostream* out) {
  *out << difference.step << " " << difference.channel << " " << difference.field << ": "
       << difference.a << ", " << difference.b;
}
bool operator==(const Difference& a, const Difference& b) {
  return a.step == b.step && a.channel == b.channel && a.field == b.field && a.a == b.a &&
         a.b == b.b;
}

namespace {

constexpr std::int64_t kStep = 7;

truth_t Truth() {
  truth_t truth{};
  truth.header = {.run_id = 1, .step = kStep, .utime = 700'000};
  truth.host_gap_m = 0.1;
  truth.num_followers = 2;
  truth.follower_gap_m = {10, 20};
  truth.follower_position_m = truth.follower_speed_mps = truth.follower_acceleration_mps2 = {0, 0};
  return truth;
}

template <class M>
std::vector<std::uint8_t> Bytes(const M& message) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(message, bytes);
  return bytes;
}

std::optional<Difference> Between(const truth_t& a, const truth_t& b) {
  return FirstDifference(IndexOf<truth_t>(), kStep, Bytes(a), Bytes(b));
}

Difference OfTruth(const std::string& field, const std::string& a, const std::string& b) {
  return {.step = kStep, .channel = "TRUTH", .field = field, .a = a, .b = b};
}

TEST(DifferenceTest, IsNoneBetweenTheSameMessageOfTwoRuns) {
  truth_t other = Truth();
  other.header.run_id = 2;
  EXPECT_EQ(Between(Truth(), other), std::nullopt);
}

TEST(DifferenceTest, TellsTheLastBitOfANumber) {
  truth_t other = Truth();
  other.host_gap_m = std::nextafter(0.1, 1);
  EXPECT_EQ(Between(Truth(), other), OfTruth("host_gap_m", "0.1", "0.10000000000000002"));
}

TEST(DifferenceTest, NamesThePlaceInAList) {
  truth_t other = Truth();
  other.follower_gap_m[1] = 21;
  EXPECT_EQ(Between(Truth(), other), OfTruth("follower_gap_m[1]", "20", "21"));
}

TEST(DifferenceTest, ShowsASmallIntegerAsANumber) {
  truth_t other = Truth();
  other.collision = truth_t::COLLISION_FOLLOWER;
  EXPECT_EQ(Between(Truth(), other), OfTruth("collision", "0", "2"));
}

TEST(DifferenceTest, IsTheFirstOfSeveral) {
  truth_t other = Truth();
  other.header.utime = 800'000;
  other.host_gap_m = 5;
  EXPECT_EQ(Between(Truth(), other), OfTruth("header.utime", "700000", "800000"));
}

TEST(DifferenceTest, MayBeAMissingMessage) {
  const std::vector<std::uint8_t> there = Bytes(Truth());
  const std::size_t channel = IndexOf<truth_t>();
  EXPECT_EQ(FirstDifference(channel, kStep, there, {}), OfTruth("(message)", "there", "none"));
  EXPECT_EQ(FirstDifference(channel, kStep, {}, there), OfTruth("(message)", "none", "there"));
  EXPECT_EQ(FirstDifference(channel, kStep, {}, {}), std::nullopt);
}

TEST(DifferenceTest, MayBeAMessageThatCannotBeRead) {
  std::vector<std::uint8_t> torn = Bytes(Truth());
  torn.pop_back();
  EXPECT_EQ(FirstDifference(IndexOf<truth_t>(), kStep, Bytes(Truth()), torn),
            OfTruth("(does not decode)", "decodes", "does not"));
}

TEST(DifferenceTest, MayBeAMessageOfAnotherType) {
  std::vector<std::uint8_t> other = Bytes(Truth());
  other[0] ^= 1;  // the fingerprint of the type
  EXPECT_EQ(FirstDifference(IndexOf<truth_t>(), kStep, other, Bytes(Truth())),
            OfTruth("(does not decode)", "does not", "decodes"));
}

TEST(DifferenceTest, OfAStepIsOnTheFirstChannelInTheOrderOfTheGraph) {
  // GIVEN two steps whose RADAR and DRIVER_COMMAND differ
  const std::vector<std::uint8_t> radar_a = Bytes(radar_t{});
  const std::vector<std::uint8_t> driver_a = Bytes(driver_command_t{});
  radar_t radar{};
  radar.range_m = 3;
  driver_command_t driver{};
  driver.readiness = 1;
  const std::vector<std::uint8_t> radar_b = Bytes(radar);
  const std::vector<std::uint8_t> driver_b = Bytes(driver);
  log::StepMessages a{};
  log::StepMessages b{};
  a[IndexOf<driver_command_t>()] = driver_a;
  b[IndexOf<driver_command_t>()] = driver_b;
  const Difference on_driver{
      .step = kStep, .channel = "DRIVER_COMMAND", .field = "readiness", .a = "0", .b = "1"};
  EXPECT_EQ(FirstDifference(kStep, a, b), on_driver);
  a[IndexOf<radar_t>()] = radar_a;
  b[IndexOf<radar_t>()] = radar_b;
  const Difference on_radar{
      .step = kStep, .channel = "RADAR", .field = "range_m", .a = "0", .b = "3"};
  EXPECT_EQ(FirstDifference(kStep, a, b), on_radar);
  EXPECT_EQ(FirstDifference(kStep, a, a), std::nullopt);
}

}  // namespace
}  // namespace fogline::replay
