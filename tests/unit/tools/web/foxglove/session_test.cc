#include "tools/web/foxglove/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "services/runtime/wire/wire.h"

namespace fogline::web::foxglove {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

class SessionTest : public testing::Test {
 protected:
  SessionTest() {
    channels_.Add({.id = 1, .topic = "TRUTH", .type = FoglineTypes().Named("truth_t")});
    channels_.Add({.id = 5, .topic = "HOST_EGO", .type = FoglineTypes().Named("ego_t")});
  }

  /// The message of the status that answers a frame; "" if nothing answers it.
  std::string Error(std::string_view bytes, bool binary = false) {
    const auto [answers, error] = session_.Received(bytes, binary);
    EXPECT_EQ(error.empty(), answers.empty());
    if (answers.empty()) return "";
    EXPECT_EQ(answers.size(), 1U);
    EXPECT_FALSE(answers[0].binary);
    const Json json = Json::parse(answers[0].bytes);
    EXPECT_EQ(json["op"], "status");
    EXPECT_EQ(json["level"], 2);
    return json["message"];
  }

  static std::vector<std::uint8_t> Ego(double speed_mps) {
    ego_t ego{};
    ego.speed_mps = speed_mps;
    std::vector<std::uint8_t> bytes;
    runtime::Encode(ego, bytes);
    return bytes;
  }

  Channels channels_{FoglineTypes()};
  Session session_{channels_};
};

TEST_F(SessionTest, BeginsWithServerInfoAndAllChannels) {
  const std::vector<Frame> frames = session_.Opened();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_FALSE(frames[0].binary);
  EXPECT_EQ(frames[0].bytes, R"({"op":"serverInfo","name":"fogline view","capabilities":[],)"
                             R"("supportedEncodings":[],"metadata":{}})");
  const Json advertise = Json::parse(frames[1].bytes);
  EXPECT_EQ(advertise["op"], "advertise");
  ASSERT_EQ(advertise["channels"].size(), 2U);
  const Json& channel = advertise["channels"][1];
  EXPECT_EQ(channel["id"], 5);
  EXPECT_EQ(channel["topic"], "HOST_EGO");
  EXPECT_EQ(channel["encoding"], "json");
  EXPECT_EQ(channel["schemaName"], "fogline.ego_t");
  EXPECT_EQ(channel["schemaEncoding"], "jsonschema");
  const Json schema = Json::parse(channel["schema"].get<std::string>());
  EXPECT_EQ(schema["properties"]["speed_mps"]["type"], "number");
}

TEST_F(SessionTest, TellsAChannelThatComesLater) {
  const Channel& radar =
      channels_.Add({.id = 9, .topic = "RADAR", .type = FoglineTypes().Named("radar_t")});
  const Json advertise = Json::parse(session_.Advertised(radar).bytes);
  ASSERT_EQ(advertise["channels"].size(), 1U);
  EXPECT_EQ(advertise["channels"][0]["topic"], "RADAR");
  EXPECT_EQ(Error(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":9}]})"), "");
}

TEST_F(SessionTest, SendsMessagesOfASubscribedChannelUnderTheClientsNumber) {
  EXPECT_FALSE(session_.Subscribed());
  EXPECT_EQ(Error(R"({"op":"subscribe","subscriptions":[{"id":258,"channelId":5}]})"), "");
  EXPECT_TRUE(session_.Subscribed());
  const auto frame = session_.Message(5, 0x0102030405060708, Ego(20.5));
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->binary);
  EXPECT_EQ(frame->bytes.substr(0, 13),
            std::string("\x01\x02\x01\0\0\x08\x07\x06\x05\x04\x03\x02\x01", 13));
  EXPECT_EQ(Json::parse(frame->bytes.substr(13))["speed_mps"], 20.5);
  EXPECT_FALSE(session_.Message(1, 0, Ego(1)));
}

TEST_F(SessionTest, SendsNothingAfterUnsubscribe) {
  Error(R"({"op":"subscribe","subscriptions":[{"id":3,"channelId":5},{"id":4,"channelId":1}]})");
  EXPECT_TRUE(session_.Message(5, 0, Ego(1)));
  EXPECT_EQ(Error(R"({"op":"unsubscribe","subscriptionIds":[3,4]})"), "");
  EXPECT_FALSE(session_.Message(5, 0, Ego(1)));
  EXPECT_FALSE(session_.Subscribed());
  // The client may use the number again.
  EXPECT_EQ(Error(R"({"op":"subscribe","subscriptions":[{"id":3,"channelId":5}]})"), "");
}

TEST_F(SessionTest, CountsMessagesThatAreOfAnotherType) {
  Error(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":1}]})");
  EXPECT_FALSE(session_.Message(1, 0, Ego(1)));
  EXPECT_EQ(session_.undecodable(), 1);
}

TEST_F(SessionTest, HasOneSubscriptionOfAChannelAndOneUseOfANumber) {
  Error(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":1}]})");
  EXPECT_EQ(Error(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1}]})"),
            "channel 1 has a subscription already");
  EXPECT_EQ(Error(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":5}]})"),
            "the subscription 0 exists already");
}

TEST_F(SessionTest, TakesTheGoodEntriesOfARequestAndAnswersTheOthersOnce) {
  EXPECT_EQ(Error(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":2},)"
                  R"({"id":1,"channelId":5},{"id":2},7]})"),
            "there is no channel 2; and 2 more");
  EXPECT_TRUE(session_.Message(5, 0, Ego(1)));
  EXPECT_EQ(Error(R"({"op":"unsubscribe","subscriptionIds":[9,1,"x"]})"),
            "there is no subscription 9; and 1 more");
  EXPECT_FALSE(session_.Message(5, 0, Ego(1)));
}

TEST_F(SessionTest, RefusesNumbersThatDoNotFitIntoTheProtocol) {
  for (const char* id : {"-1", "4294967296", "1.5", "1e400", "\"1\"", "null", "true", "[]"}) {
    const std::string text =
        std::string(R"({"op":"subscribe","subscriptions":[{"id":)") + id + R"(,"channelId":5}]})";
    EXPECT_NE(Error(text), "") << id;
  }
  EXPECT_FALSE(session_.Subscribed());
  EXPECT_EQ(Error(R"({"op":"subscribe","subscriptions":[{"id":4294967295,"channelId":5}]})"), "");
}

TEST_F(SessionTest, AnswersEveryFrameThatItDoesNotUnderstand) {
  for (const char* text : {"", "{", "[]", "1", "null", "{}", R"({"op":7})", R"({"op":"dance"})",
                           R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":{}})",
                           R"({"op":"unsubscribe","subscriptionIds":3})", "\xff\xfe"}) {
    EXPECT_NE(Error(text), "") << text;
  }
  EXPECT_EQ(Error(std::string(1, '\7'), true), "no binary frame begins with the byte 7");
  EXPECT_EQ(Error("", true), "a binary frame is empty");
}

TEST_F(SessionTest, LetsNoClientSendMessagesCallServicesOrChangeParameters) {
  EXPECT_THAT(Error(std::string("\1\0\0\0\0abc", 8), true), HasSubstr("\"clientPublish\""));
  EXPECT_THAT(Error("\2", true), HasSubstr("\"services\""));
  EXPECT_THAT(Error(R"({"op":"advertise","channels":[]})"), HasSubstr("\"clientPublish\""));
  EXPECT_THAT(Error(R"({"op":"setParameters"})"), HasSubstr("\"parameters\""));
  EXPECT_THAT(Error(R"({"op":"subscribeConnectionGraph"})"), HasSubstr("\"connectionGraph\""));
  EXPECT_THAT(Error(R"({"op":"fetchAsset","uri":"/etc/passwd"})"), HasSubstr("\"assets\""));
}

TEST_F(SessionTest, AnswersADeepFrameWithoutDeepRecursion) {
  EXPECT_NE(Error(std::string(65536, '[')), "");
  EXPECT_NE(Error(std::string(30000, '[') + std::string(30000, ']')), "");
}

}  // namespace
}  // namespace fogline::web::foxglove
