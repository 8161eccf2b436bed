#include "services/runtime/wire/wire.h"

#include <gtest/gtest.h>

#include <limits>

#include "services/runtime/wire/digest.h"

namespace fogline {
namespace {

ego_t SomeEgo() {
  ego_t ego{};
  ego.header.run_id = 77;
  ego.header.step = 12;
  ego.header.utime = 1'200'000;
  ego.speed_mps = 20.5;
  ego.acceleration_mps2 = -0.25;
  return ego;
}

TEST(WireTest, ReadsTheHeaderWhereEveryMessageHasIt) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(SomeEgo(), bytes);
  EXPECT_EQ(runtime::ReadInt64(bytes, 0), ego_t::getHash());
  EXPECT_EQ(runtime::ReadInt64(bytes, runtime::kRunIdOffset), 77);
  EXPECT_EQ(runtime::ReadInt64(bytes, runtime::kStepOffset), 12);
  EXPECT_EQ(runtime::ReadInt64(bytes, runtime::kStepOffset + 8), 1'200'000);
}

TEST(WireTest, DecodesOnlyExactlyOneMessageOfTheType) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(SomeEgo(), bytes);
  ego_t ego{};
  EXPECT_TRUE(runtime::Decode(bytes, ego));
  EXPECT_EQ(ego.speed_mps, 20.5);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(runtime::Decode(runtime::Bytes(bytes).first(size), ego)) << size << " bytes";
  }
  radar_t radar{};
  EXPECT_FALSE(runtime::Decode(bytes, radar));
  bytes.push_back(0);
  EXPECT_FALSE(runtime::Decode(bytes, ego));
}

TEST(WireTest, RefusesAnArrayThatClaimsMoreElementsThanTheMessageHasBytes) {
  follower_command_t command{};
  command.num_followers = 1;
  command.acceleration_mps2 = {0.5};
  command.safe_distance_m = {33};
  std::vector<std::uint8_t> bytes;
  runtime::Encode(command, bytes);
  for (const std::uint32_t claim : {0x7fffffffU, 0xffffffffU, 0x80000000U, 1000U, 2U}) {
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[runtime::kHeaderEnd + i] = static_cast<std::uint8_t>(claim >> (24 - 8 * i));
    }
    EXPECT_FALSE(runtime::Decode(bytes, command)) << claim;
  }
}

// A process decodes all messages of a channel into the same object. No element of an earlier
// message may stay in this object.
TEST(WireTest, ForgetsTheElementsOfTheMessageBefore) {
  follower_command_t command{};
  command.num_followers = 1;
  command.acceleration_mps2 = {std::numeric_limits<double>::quiet_NaN()};
  command.safe_distance_m = {33};
  const follower_command_t empty{};
  std::vector<std::uint8_t> bytes;
  runtime::Encode(empty, bytes);
  ASSERT_TRUE(runtime::Decode(bytes, command));
  EXPECT_TRUE(command.acceleration_mps2.empty());
  EXPECT_TRUE(command.safe_distance_m.empty());
  EXPECT_EQ(runtime::FirstNonFiniteField(command), "");
}

TEST(WireTest, RefusesATextOfAnArrayThatClaimsAnImpossibleLength) {
  status_t status{};
  status.num_inputs = 2;
  status.input = {"RADAR", "LIDAR"};
  status.input_state = {0, 0};
  status.input_age_us = {0, 0};
  status.input_rate_hz = {0, 0};
  status.input_late = {0, 0};
  std::vector<std::uint8_t> bytes;
  runtime::Encode(status, bytes);
  ASSERT_TRUE(runtime::Decode(bytes, status));
  EXPECT_EQ(status.input.at(1), "LIDAR");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t length = text.find("LIDAR") - 4;
  for (const std::uint32_t claim : {0U, 0x7fffffffU, 0xffffffffU, 0x80000000U, 1000U}) {
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[length + i] = static_cast<std::uint8_t>(claim >> (24 - 8 * i));
    }
    EXPECT_FALSE(runtime::Decode(bytes, status)) << claim;
  }
}

TEST(WireTest, FindsValuesThatAreNotFinite) {
  ego_t ego = SomeEgo();
  EXPECT_EQ(runtime::FirstNonFiniteField(ego), "");
  ego.acceleration_mps2 = std::numeric_limits<double>::infinity();
  EXPECT_EQ(runtime::FirstNonFiniteField(ego), "acceleration_mps2");
  truth_t truth{};
  truth.num_followers = 1;
  truth.follower_position_m = {0};
  truth.follower_speed_mps = {0};
  truth.follower_acceleration_mps2 = {0};
  truth.follower_gap_m = {std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(runtime::FirstNonFiniteField(truth), "follower_gap_m");
  track_t track{};
  track.covariance[2][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(runtime::FirstNonFiniteField(track), "covariance");
  track.innovation_variance[2] = std::numeric_limits<double>::quiet_NaN();
  track.state[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(runtime::FirstNonFiniteField(track), "state");
  track.state[1] = 0;
  track.covariance[2][1] = 0;
  EXPECT_EQ(runtime::FirstNonFiniteField(track), "innovation_variance");
}

TEST(DigestTest, LeavesTheRunIdOutAndNothingElse) {
  std::vector<std::uint8_t> bytes;
  const auto digest_of = [&bytes](const ego_t& ego) {
    runtime::Encode(ego, bytes);
    runtime::Digest digest;
    digest.Add(bytes);
    return digest.Hex();
  };
  const std::string digest = digest_of(SomeEgo());
  ego_t other = SomeEgo();
  other.header.run_id = 78;
  EXPECT_EQ(digest_of(other), digest);
  other.header.step = 13;
  EXPECT_NE(digest_of(other), digest);
  other = SomeEgo();
  other.speed_mps = std::nextafter(other.speed_mps, 100);
  EXPECT_NE(digest_of(other), digest);
  EXPECT_EQ(digest.size(), 64U);
}

}  // namespace
}  // namespace fogline
