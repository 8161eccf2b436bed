#include "tools/web/types/field_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "common/errors.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/numeric_fields.h"
#include "tools/web/types/decode.h"
#include "tools/web/types/fields.h"

namespace fogline::web {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const LcmStruct& Type(std::string_view name) { return *FoglineTypes().Named(name); }

template <class M>
std::vector<std::uint8_t> Encoded(const M& message) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(message, bytes);
  return bytes;
}

template <class M>
std::optional<double> Value(const M& message, std::string_view path) {
  return FieldReader(FoglineTypes(), Type(M::getTypeName()), path)(Encoded(message));
}

truth_t Truth() {
  truth_t truth{};
  truth.header = {.run_id = 7, .step = 41, .utime = 4'100'000};
  truth.host_gap_m = 60.5;
  truth.num_followers = 2;
  truth.follower_position_m = {-40, -80};
  truth.follower_speed_mps = {20, 21};
  truth.follower_acceleration_mps2 = {0.5, -0.5};
  truth.follower_gap_m = {38, 39};
  truth.fog_present = 1;
  truth.collision_time_s = 12.5;
  return truth;
}

TEST(FieldReaderTest, ReadsNumbersBeforeInAndBehindArraysOfVaryingLength) {
  const truth_t truth = Truth();
  EXPECT_EQ(Value(truth, "header.step"), 41.0);
  EXPECT_EQ(Value(truth, "host_gap_m"), 60.5);
  EXPECT_EQ(Value(truth, "num_followers"), 2.0);
  EXPECT_EQ(Value(truth, "follower_speed_mps[1]"), 21.0);
  EXPECT_EQ(Value(truth, "follower_gap_m[0]"), 38.0);
  EXPECT_EQ(Value(truth, "fog_present"), 1.0);
  EXPECT_EQ(Value(truth, "collision_time_s"), 12.5);
  EXPECT_EQ(Value(truth, "last"), 0.0);
}

TEST(FieldReaderTest, ReadsNumbersBehindTexts) {
  status_t status{};
  status.role = "fusion";
  status.error = "no disk";
  status.num_inputs = 2;
  status.input = {"RADAR", "LIDAR"};
  status.input_state = {1, 2};
  status.input_age_us = {5, 6};
  status.input_rate_hz = {10, 9.5};
  status.input_late = {0, 3};
  status.latency_max_us = 77;
  EXPECT_EQ(Value(status, "input_rate_hz[1]"), 9.5);
  EXPECT_EQ(Value(status, "input_late[1]"), 3.0);
  EXPECT_EQ(Value(status, "latency_max_us"), 77.0);
}

TEST(FieldReaderTest, ReadsAnElementOfAMatrix) {
  track_t track{};
  track.covariance[0][2] = 2;
  track.covariance[2][0] = 6;
  EXPECT_EQ(Value(track, "covariance[0][2]"), 2.0);
  EXPECT_EQ(Value(track, "covariance[2][0]"), 6.0);
}

TEST(FieldReaderTest, HasNoValueForAnElementThatTheMessageDoesNotHave) {
  EXPECT_EQ(Value(Truth(), "follower_gap_m[2]"), std::nullopt);
  EXPECT_EQ(Value(truth_t{}, "follower_gap_m[0]"), std::nullopt);
}

TEST(FieldReaderTest, HasNoValueForANumberThatIsNotFinite) {
  ego_t ego{};
  for (const double value : {std::nan(""), HUGE_VAL}) {
    ego.speed_mps = value;
    EXPECT_EQ(Value(ego, "speed_mps"), std::nullopt);
  }
}

TEST(FieldReaderTest, HasNoValueInAMessageOfAnotherTypeOrWithoutItsEnd) {
  const FieldReader reader(FoglineTypes(), Type("truth_t"), "follower_gap_m[1]");
  EXPECT_EQ(reader(Encoded(ego_t{})), std::nullopt);
  const std::vector<std::uint8_t> bytes = Encoded(Truth());
  // These fields follow the gaps: fog_present, fog_level, fog_visibility_m, collision, the time of
  // the collision, last.
  const std::size_t end = bytes.size() - (1 + 8 + 8 + 1 + 8 + 1);
  EXPECT_EQ(reader(Bytes(bytes).first(end)), 39.0);
  for (std::size_t size = 0; size < end; ++size) {
    EXPECT_EQ(reader(Bytes(bytes).first(size)), std::nullopt) << size;
  }
}

TEST(FieldReaderTest, ReadsEveryListedFieldAsTheDecoderDoes) {
  truth_t truth = Truth();
  const std::vector<std::uint8_t> bytes = Encoded(truth);
  const nlohmann::ordered_json json = *DecodeJson(FoglineTypes(), Type("truth_t"), bytes);
  const test::NumericFields fields(FoglineTypes(), Type("truth_t"), {.varying = 2});
  EXPECT_EQ(fields.paths().size(), 25U);
  for (const std::string& path : fields.paths()) {
    nlohmann::ordered_json value = json;
    for (const PathPart& part : ParsePath(path)) {
      value = value.at(part.name);
      for (const std::size_t index : part.indices) value = value.at(index);
    }
    const double expected =
        value.is_boolean() ? (value.get<bool>() ? 1.0 : 0.0) : value.get<double>();
    EXPECT_EQ(FieldReader(FoglineTypes(), Type("truth_t"), path)(bytes), expected) << path;
  }
}

std::string PathErrorOf(std::string_view path) {
  try {
    FieldReader reader(FoglineTypes(), Type("truth_t"), path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FieldReaderTest, SaysWhatIsWrongWithAPath) {
  EXPECT_EQ(PathErrorOf("host_gap"),
            "truth_t has no field \"host_gap\"; did you mean \"host_gap_m\"?");
  EXPECT_EQ(PathErrorOf("header"), "\"header\" is no number but a struct");
  EXPECT_EQ(PathErrorOf("host_gap_m.x"), "\"host_gap_m.x\": host_gap_m has no fields");
  EXPECT_EQ(PathErrorOf("host_gap_m[0]"), "host_gap_m needs 0 indices, not 1");
  EXPECT_EQ(PathErrorOf("follower_gap_m"), "follower_gap_m needs 1 index, not 0");
  for (const char* path : {"", ".", "a.", "a[", "a[]", "a[-1]", "a[1", "a]", "a[1]b", "[0]",
                           "a[99999999999999999999]", "a[0x1]"}) {
    EXPECT_THAT(PathErrorOf(path), HasSubstr("is no field: write")) << path;
  }
}

TEST(FieldReaderTest, RefusesATextAndAnIndexThatNoMessageHas) {
  EXPECT_THROW(FieldReader(FoglineTypes(), Type("status_t"), "role"), InputError);
  EXPECT_THROW(FieldReader(FoglineTypes(), Type("track_t"), "state[3]"), InputError);
  EXPECT_NO_THROW(FieldReader(FoglineTypes(), Type("track_t"), "state[2]"));
}

TEST(FieldPathTest, HasNamesAndIndices) {
  EXPECT_THAT(ParsePath("a.b_2[0][13].c"),
              ElementsAre(PathPart{"a", {}}, PathPart{"b_2", {0, 13}}, PathPart{"c", {}}));
}

}  // namespace
}  // namespace fogline::web
