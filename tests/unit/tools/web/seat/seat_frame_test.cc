#include "tools/web/seat/seat_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/runtime/wire/driver_input.h"

namespace fogline::web {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A frame in which one member has another text, or is left out (text "").
std::string Frame(const std::string& member = "", const std::string& text = "") {
  std::string frame;
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{
           {"op", R"("input")"},
           {"sequence", "7"},
           {"age_ms", "12.5"},
           {"present", "true"},
           {"throttle", "0.25"},
           {"brake", "1"},
           {"axes", "[-1,0.5]"},
           {"buttons", R"(["take_over"])"},
           {"device", R"({"kind":"wheel","name":"G29"})"},
           {"latency_ms", "17"}}) {
    const std::string& used = name == member ? text : value;
    if (used.empty()) continue;
    frame += (frame.empty() ? "{\"" : ",\"") + name + "\":" + used;
  }
  return frame + "}";
}

std::string WhyBad(const std::string& text) {
  const SeatFrame frame = ParseSeatFrame(text);
  const auto* bad = std::get_if<BadSeatFrame>(&frame);
  EXPECT_NE(bad, nullptr) << text;
  return bad == nullptr ? "" : bad->why;
}

TEST(SeatFrameTest, ReadsAnInput) {
  const auto input = std::get<SeatInput>(ParseSeatFrame(Frame()));
  EXPECT_EQ(input.sequence, 7);
  EXPECT_EQ(input.age_ms, 12.5);
  EXPECT_TRUE(input.present);
  EXPECT_EQ(input.throttle, 0.25);
  EXPECT_EQ(input.brake, 1);
  EXPECT_THAT(input.axes, ElementsAre(-1, 0.5));
  EXPECT_EQ(input.buttons, driver_input_t::TAKE_OVER);
  EXPECT_EQ(input.device_kind, driver_input_t::WHEEL);
  EXPECT_EQ(input.device, "G29");
  EXPECT_EQ(input.latency_ms, 17);
}

TEST(SeatFrameTest, NeedsAllMembersButTheLatency) {
  EXPECT_EQ(std::get<SeatInput>(ParseSeatFrame(Frame("latency_ms"))).latency_ms, std::nullopt);
  for (const char* member :
       {"op", "sequence", "age_ms", "present", "throttle", "brake", "axes", "buttons", "device"}) {
    EXPECT_THAT(WhyBad(Frame(member)), HasSubstr(std::string("\"") + member + "\" is missing"));
  }
  EXPECT_THAT(WhyBad(Frame("device", R"({"name":"G29"})")), HasSubstr("\"kind\" is missing"));
  EXPECT_THAT(WhyBad(Frame("device", R"({"kind":"wheel"})")), HasSubstr("\"name\" is missing"));
}

TEST(SeatFrameTest, RefusesValuesOutOfTheirRange) {
  for (const char* number : {"-0.1", "1.1", "\"1\"", "null", "true", "[1]", "1e999", "-1e999"}) {
    EXPECT_NE(WhyBad(Frame("throttle", number)), "") << number;
    EXPECT_NE(WhyBad(Frame("brake", number)), "") << number;
  }
  for (const char* number :
       {"-1", "1.5", "1e3", "9007199254740992", "18446744073709551615", "\"7\""}) {
    EXPECT_THAT(WhyBad(Frame("sequence", number)), HasSubstr("\"sequence\"")) << number;
  }
  for (const char* number : {"-1", "3600001", "null"}) {
    EXPECT_THAT(WhyBad(Frame("age_ms", number)), HasSubstr("\"age_ms\"")) << number;
    EXPECT_THAT(WhyBad(Frame("latency_ms", number)), HasSubstr("\"latency_ms\"")) << number;
  }
  EXPECT_THAT(WhyBad(Frame("present", "1")), HasSubstr("\"present\""));
  for (const char* axes :
       {"[0,2]", "[-1.5]", "0", "{}", "[\"0\"]", "[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]"}) {
    EXPECT_THAT(WhyBad(Frame("axes", axes)), HasSubstr("\"axes\"")) << axes;
  }
  for (const char* buttons :
       {R"(["horn"])", "[1]", "{}", "\"take_over\"", R"(["take_over","take_over","take_over"])"}) {
    EXPECT_THAT(WhyBad(Frame("buttons", buttons)), HasSubstr("\"buttons\"")) << buttons;
  }
}

TEST(SeatFrameTest, RefusesAnotherDevice) {
  EXPECT_THAT(WhyBad(Frame("device", "[]")), HasSubstr("\"device\""));
  EXPECT_THAT(WhyBad(Frame("device", R"({"kind":"evdev","name":""})")), HasSubstr("\"kind\""));
  EXPECT_THAT(WhyBad(Frame("device", R"({"kind":7,"name":""})")), HasSubstr("\"kind\""));
  const std::string most(runtime::kMostDeviceBytes, 'x');
  const auto named = [](const std::string& name) {
    return Frame("device", R"({"kind":"gamepad","name":")" + name + "\"}");
  };
  EXPECT_EQ(std::get<SeatInput>(ParseSeatFrame(named(most))).device, most);
  EXPECT_THAT(WhyBad(named(most + "x")), HasSubstr("\"name\""));
  EXPECT_THAT(WhyBad(named("a\\u0000b")), HasSubstr("\"name\""));
  EXPECT_THAT(WhyBad(named("a\\u001b[2Jb")), HasSubstr("\"name\""));
  EXPECT_THAT(WhyBad(named("\xff")), HasSubstr("no JSON"));
}

TEST(SeatFrameTest, RefusesWhatIsNoInput) {
  EXPECT_THAT(WhyBad(""), HasSubstr("no JSON"));
  EXPECT_THAT(WhyBad("{"), HasSubstr("no JSON"));
  EXPECT_THAT(WhyBad("[1]"), HasSubstr("no JSON object"));
  EXPECT_THAT(WhyBad("{}"), HasSubstr("\"op\" is missing"));
  EXPECT_THAT(WhyBad(R"({"op":"history","id":1})"), HasSubstr("only the \"op\" \"input\""));
}

}  // namespace
}  // namespace fogline::web
