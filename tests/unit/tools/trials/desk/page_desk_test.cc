#include "tools/trials/desk/page_desk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/web_client.h"

namespace fogline::trials {
namespace {

using nlohmann::json;
using test::WebClient;
using ::testing::HasSubstr;
using ::testing::Not;

/// A client of the page at this address.
WebClient Open(const std::string& address) {
  const std::size_t port = address.rfind(':') + 1;
  const std::size_t token = address.find("token=");
  return {static_cast<std::uint16_t>(std::stoi(address.substr(port))),
          {.target = token == std::string::npos ? "/ws" : "/ws?" + address.substr(token),
           .protocol = ""}};
}

/// The next state in which a frame was refused.
json Refusal(WebClient& client) {
  for (;;) {
    json state = json::parse(client.Receive().bytes);
    if (state.contains("refused")) return state;
  }
}

TEST(PageDeskTest, AMarkerAfterTheEndOfARunIsRefusedAndNotTold) {
  const std::string url = runtime::FreshMulticastUrl();
  PageDesk desk(PageOptions{});
  WebClient experimenter = Open(desk.experimenter_address());
  trial_t base{};
  base.participant = base.trial = base.attempt = 1;
  Speaker speaker(runtime::FreshMulticastUrl(), 1, {}, base);
  desk.RunBegins(speaker);
  experimenter.Send(R"({"op":"marker","text":"yawns"})");
  for (std::string state; state.find("marker: yawns") == std::string::npos;) {
    state = experimenter.Receive().bytes;
  }
  desk.RunEnded();
  experimenter.Send(R"({"op":"marker","text":"too late"})");
  const json refusal = Refusal(experimenter);
  EXPECT_EQ(refusal["refused"], "no run is under way");
  EXPECT_THAT(refusal.dump(), Not(HasSubstr("marker: too late")));
  // The log has the marker that the page shows.
  EXPECT_EQ(speaker.End().back().text, "yawns");
}

}  // namespace
}  // namespace fogline::trials
