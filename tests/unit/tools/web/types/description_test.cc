#include "tools/web/types/description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "services/graph.h"

namespace fogline::web {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

Json MemberOf(const Json& type, std::string_view name) {
  for (const Json& member : type["members"]) {
    if (member["name"] == name) return member;
  }
  ADD_FAILURE() << name;
  return nullptr;
}

TEST(DescriptionTest, DescribesEachMemberWithTypeDimensionsCommentAndUnit) {
  const Json truth = TypesJson(FoglineTypes())["truth_t"];
  EXPECT_THAT(truth["comment"].get<std::string>(), HasSubstr("Ground truth"));
  EXPECT_EQ(truth["constants"].dump(),
            R"({"COLLISION_NONE":0,"COLLISION_HOST":1,"COLLISION_FOLLOWER":2})");
  EXPECT_EQ(truth["members"][0].dump(),
            R"({"name":"header","type":"header_t","dims":[],"comment":"","unit":""})");
  EXPECT_EQ(MemberOf(truth, "host_gap_m").dump(),
            R"({"name":"host_gap_m","type":"double","dims":[],"comment":"From the host's front )"
            R"(bumper to the preceding car's rear bumper.","unit":"m"})");
  EXPECT_EQ(MemberOf(truth, "follower_gap_m")["dims"], Json({"num_followers"}));
  const Json track = TypesJson(FoglineTypes())["track_t"];
  EXPECT_EQ(MemberOf(track, "covariance")["dims"], Json({3, 3}));
}

TEST(DescriptionTest, CommentsAreInPlainText) {
  // The page shows the comment of a member. So the text must not contain the slashes of a comment
  // or a line feed.
  for (const Json& type : TypesJson(FoglineTypes())) {
    for (const Json& member : type["members"]) {
      const std::string comment = member["comment"];
      EXPECT_EQ(comment.find("//"), std::string::npos) << comment;
      EXPECT_EQ(comment.find('\n'), std::string::npos) << comment;
    }
  }
}

TEST(DescriptionTest, WritesFingerprintsAsHexadecimalNumbers) {
  const Json fingerprints = FingerprintsJson(FoglineTypes());
  EXPECT_EQ(fingerprints.size(), FoglineTypes().structs().size());
  const std::string text = fingerprints["radar_t"];
  ASSERT_EQ(text.size(), 18U);
  EXPECT_EQ(std::stoull(text.substr(2), nullptr, 16),
            static_cast<std::uint64_t>(radar_t::getHash()));
}

TEST(DescriptionTest, NamesTheChannelsOfTheGraphByTheirPlaces) {
  const Json channels = ChannelsJson();
  ASSERT_EQ(channels.size(), kNumChannels);
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    EXPECT_EQ(channels[i]["id"], i);
    EXPECT_EQ(channels[i]["name"], kChannels[i].name);
  }
  EXPECT_EQ(channels[1].dump(),
            R"({"id":1,"name":"TRUTH","type":"truth_t","from":"world","what":"ground truth: )"
            R"(positions, speeds, accelerations, gaps, fog"})");
  EXPECT_EQ(channels[0]["from"], "runner");
  EXPECT_EQ(channels[ChannelNamed("STATUS")]["from"], "everyone");
  EXPECT_EQ(channels[ChannelNamed("RESEND")]["from"], "everyone");
}

/// Expects that a schema, and every schema in it, has exactly one type. Foxglove's readers demand
/// this.
void ExpectOneType(const Json& schema) {
  ASSERT_TRUE(schema["type"].is_string()) << schema;
  if (schema["type"] == "array") ExpectOneType(schema["items"]);
  if (schema["type"] != "object") return;
  for (const Json& property : schema["properties"]) ExpectOneType(property);
  EXPECT_EQ(schema["required"].size(), schema["properties"].size());
}

TEST(DescriptionTest, MakesSchemasOfOneTypeEach) {
  for (const LcmStruct& type : FoglineTypes().structs()) {
    const Json schema = SchemaJson(FoglineTypes(), type);
    EXPECT_EQ(schema["title"], "fogline." + type.name);
    ExpectOneType(schema);
  }
  const Json track = SchemaJson(FoglineTypes(), *FoglineTypes().Named("track_t"));
  EXPECT_EQ(track["properties"]["covariance"]["items"]["items"]["type"], "number");
  EXPECT_EQ(track["properties"]["valid"]["type"], "boolean");
  EXPECT_EQ(track["properties"]["header"]["properties"]["step"]["type"], "integer");
  const Json radar = SchemaJson(FoglineTypes(), *FoglineTypes().Named("radar_t"));
  EXPECT_THAT(radar["properties"]["range_rate_mps"].dump(), HasSubstr("[m/s]"));
}

}  // namespace
}  // namespace fogline::web
