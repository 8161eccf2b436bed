#include "tools/web/types/decode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include <nlohmann/json.hpp>

#include "services/runtime/wire/wire.h"
#include "tools/web/types/lcm_parser.h"

namespace fogline::web {
namespace {

using Json = nlohmann::ordered_json;

template <class M>
std::optional<Json> Decoded(const M& message) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(message, bytes);
  return DecodeJson(FoglineTypes(), *FoglineTypes().Named(M::getTypeName()), bytes);
}

/// The bytes of a message of a type that lcm-gen has not seen: fingerprint, then `rest`.
std::vector<std::uint8_t> Message(const LcmStruct& type, std::vector<std::uint8_t> rest) {
  for (int i = 0; i < 8; ++i) {
    rest.insert(rest.begin(), static_cast<std::uint8_t>(type.fingerprint >> (8 * i)));
  }
  return rest;
}

TEST(DecodeTest, HasTheMembersOfATypeInTheirOrder) {
  radar_t radar{};
  radar.header = {.run_id = 7, .step = 3, .utime = 300'000};
  radar.valid = 1;
  radar.range_m = 60.25;
  radar.range_rate_mps = -1.5;
  const auto json = Decoded(radar);
  ASSERT_TRUE(json);
  EXPECT_EQ(json->dump(),
            R"({"header":{"run_id":7,"step":3,"utime":300000},"valid":true,"range_m":60.25,)"
            R"("range_rate_mps":-1.5,"range_std_m":0.0,"range_rate_std_mps":0.0})");
}

TEST(DecodeTest, WritesArraysAsListsOfLists) {
  track_t track{};
  track.covariance[1][2] = 5;
  track.usage[2] = track_t::GATED;
  const auto json = Decoded(track);
  ASSERT_TRUE(json);
  EXPECT_EQ((*json)["covariance"].size(), 3U);
  EXPECT_EQ((*json)["covariance"][1][2], 5.0);
  EXPECT_EQ((*json)["usage"], Json({0, 0, 2}));

  truth_t truth{};
  EXPECT_EQ((*Decoded(truth))["follower_gap_m"], Json::array());
  truth.num_followers = 2;
  truth.follower_position_m = truth.follower_speed_mps = truth.follower_acceleration_mps2 = {1, 2};
  truth.follower_gap_m = {38.5, 39};
  EXPECT_EQ((*Decoded(truth))["follower_gap_m"], Json({38.5, 39.0}));
}

TEST(DecodeTest, WritesIntegersThatJavaScriptWouldRoundAsText) {
  constexpr std::int64_t kExact = std::int64_t{1} << 53;
  ego_t ego{};
  for (const std::int64_t exact : {std::int64_t{0}, kExact, -kExact}) {
    ego.header.run_id = exact;
    EXPECT_EQ((*Decoded(ego))["header"]["run_id"], exact);
  }
  ego.header.run_id = kExact + 1;
  EXPECT_EQ((*Decoded(ego))["header"]["run_id"], "9007199254740993");
  ego.header.run_id = std::numeric_limits<std::int64_t>::min();
  EXPECT_EQ((*Decoded(ego))["header"]["run_id"], "-9223372036854775808");
}

TEST(DecodeTest, WritesNumbersThatAreNotFiniteAsNull) {
  ego_t ego{};
  for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    ego.speed_mps = value;
    EXPECT_TRUE((*Decoded(ego))["speed_mps"].is_null());
  }
}

TEST(DecodeTest, MakesUtf8OfAnyText) {
  status_t status{};
  status.role = "f\xc3\xbcr";
  status.error = "a\xff\xc3z";
  const auto json = Decoded(status);
  ASSERT_TRUE(json);
  EXPECT_EQ((*json)["role"], "f\xc3\xbcr");
  EXPECT_EQ((*json)["error"], "a\xef\xbf\xbd\xef\xbf\xbdz");
  EXPECT_NO_THROW(json->dump());
}

TEST(DecodeTest, RefusesBytesThatAreNotExactlyOneMessage) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(ego_t{}, bytes);
  const LcmStruct& ego = *FoglineTypes().Named("ego_t");
  EXPECT_TRUE(DecodeJson(FoglineTypes(), ego, bytes));
  EXPECT_FALSE(DecodeJson(FoglineTypes(), *FoglineTypes().Named("radar_t"), bytes));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(DecodeJson(FoglineTypes(), ego, Bytes(bytes).first(size))) << size;
  }
  bytes.push_back(0);
  EXPECT_FALSE(DecodeJson(FoglineTypes(), ego, bytes));
}

TEST(DecodeTest, BelievesNoLengthThatTheMessageHasNoRoomFor) {
  follower_command_t command{};
  command.num_followers = 1;
  command.acceleration_mps2 = {1};
  command.safe_distance_m = {2};
  std::vector<std::uint8_t> bytes;
  runtime::Encode(command, bytes);
  const LcmStruct& type = *FoglineTypes().Named("follower_command_t");
  ASSERT_TRUE(DecodeJson(FoglineTypes(), type, bytes));
  for (const std::uint8_t first :
       std::initializer_list<std::uint8_t>{0x7f, 0x80, 0xff}) {  // the length's highest byte
    bytes[32] = first;
    EXPECT_FALSE(DecodeJson(FoglineTypes(), type, bytes)) << int{first};
  }
}

TEST(DecodeTest, DecodesTypesThatFoglineDoesNotUse) {
  const LcmTypes types(
      ParseLcm("struct part_t { byte b; boolean ok; string s; }"
               "struct all_t { int16_t rows; int8_t cols; float f; int16_t grid[rows][cols];"
               "  part_t parts[rows]; int64_t big[2]; }",
               "a.lcm"));
  const LcmStruct& all = *types.Named("all_t");
  const std::vector<std::uint8_t> bytes = Message(
      all, {0,   2, 3, 0x3f, 0x80, 0, 0,                                   // rows, cols, f
            0,   1, 0, 2,    0,    3, 0xff, 0xff, 0x80, 0,    0x7f, 0xff,  // grid
            200, 1, 0, 0,    0,    3, 'h',  'i',  0,                       // parts[0]
            0,   0, 0, 0,    0,    1, 0,                                   // parts[1]
            0,   0, 0, 0,    0,    0, 0,    1,    0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff});
  const auto json = DecodeJson(types, all, bytes);
  ASSERT_TRUE(json);
  EXPECT_EQ(json->dump(),
            R"({"rows":2,"cols":3,"f":1.0,"grid":[[1,2,3],[-1,-32768,32767]],)"
            R"("parts":[{"b":200,"ok":true,"s":"hi"},{"b":0,"ok":false,"s":""}],"big":[1,-1]})");
}

TEST(DecodeTest, NeedsLittleMemoryForManyDimensionsOfLengthZero) {
  const LcmTypes types(ParseLcm("struct a_t { int32_t n, m; int8_t x[n][n][m]; }", "a.lcm"));
  const LcmStruct& type = *types.Named("a_t");
  // With n = 65536 and m = 0, lists of lists would contain n * n = 2^32 empty lists. The decoder
  // gives one empty list in their place.
  auto json = DecodeJson(types, type, Message(type, {0, 1, 0, 0, 0, 0, 0, 0}));
  ASSERT_TRUE(json);
  EXPECT_EQ((*json)["x"], Json::array());
  json = DecodeJson(types, type, Message(type, {0, 0, 0, 0, 0, 0, 0, 9}));  // n = 0, m = 9
  ASSERT_TRUE(json);
  EXPECT_EQ((*json)["x"], Json::array());
  EXPECT_FALSE(DecodeJson(types, type, Message(type, {0, 1, 0, 0, 0, 0, 0, 1})));
  EXPECT_FALSE(DecodeJson(types, type, Message(type, {0, 0, 0, 0, 0xff, 0, 0, 0})));  // m < 0
}

}  // namespace
}  // namespace fogline::web
