// A message of a run is altered on its way. The alteration is found when the steps of the log are
// computed again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

#include "services/graph.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;
using Payload = std::vector<std::uint8_t>;

/// A bridge between a run and one of its roles, which is on another network. The bridge carries
/// messages in both directions, and alters one message.
class Bridge {
 public:
  Bridge(const std::string& run, const std::string& role) : run_(run), role_(role) {
    for (const char* channel : {"RUN", "TRUTH", "RESEND"}) Carry(run_, role_, channel);
    for (const char* channel : {"LIDAR", "STATUS", "RESEND"}) Carry(role_, run_, channel);
  }

  /// Tells the bridge to make the LiDAR's range of this step larger.
  void Alter(std::int64_t step) { altered_ = step; }

  void RunUntilTheEndOf(const Background& program) {
    while (IsAlive(program.pid())) {
      run_.Wait(milliseconds(1));
      run_.Drain();
      role_.Drain();
    }
  }

 private:
  void Carry(runtime::Bus& from, runtime::Bus& to, const std::string& channel) {
    const bool of_lidar = &from == &role_;
    from.Subscribe(channel, [this, &to, channel, of_lidar](runtime::Bytes bytes) {
      // RESEND crosses the bridge in both directions. Each bus also receives the RESEND that the
      // bridge itself publishes there. The bridge must not carry this message back.
      resend_t resend{};
      if (channel == ChannelOf<resend_t>().name && runtime::Decode(bytes, resend) &&
          (resend.requester == NameOf(Role::kLidar)) != of_lidar) {
        return;
      }
      Payload payload(bytes.begin(), bytes.end());
      lidar_t lidar{};
      if (runtime::Decode(payload, lidar) && lidar.header.step == altered_) {
        lidar.range_m += 0.25;
        runtime::Encode(lidar, payload);
      }
      to.Publish(channel, payload);
    });
  }

  runtime::Bus run_;
  runtime::Bus role_;
  std::int64_t altered_ = -1;
};

class AlteredTrafficTest : public testing::Test {
 protected:
  /// Makes a run whose LiDAR is on the other side of the bridge.
  Outcome RunAcross(Bridge& bridge, const Words& more) {
    const Background lidar({Program("fogline-lidar"), "--lcm-url", lidar_url_});
    Words command{Program("fogline"), "run",        "scenario/paper.json",
                  "--json",           "--external", "lidar",
                  "--lcm-url",        url_,         "--set",
                  "/steps=50",        "--log",      folder_.File("run.lcm")};
    command.insert(command.end(), more.begin(), more.end());
    Background run(command);
    bridge.RunUntilTheEndOf(run);
    const int code = run.Wait();
    return {.code = code, .out = run.Out(), .err = run.Err() + "the lidar says: " + lidar.Err()};
  }

  const ScratchFolder folder_;
  const std::string url_ = runtime::Bus(runtime::FreshMulticastUrl()).url();
  const std::string lidar_url_ = runtime::Bus(runtime::FreshMulticastUrl()).url();
  Bridge bridge_{url_, lidar_url_};
};

TEST_F(AlteredTrafficTest, IsFoundByComputingTheStepsAgain) {
  bridge_.Alter(20);
  const Outcome run = RunAcross(bridge_, {});
  EXPECT_EQ(run.code, 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("fogline run: error: step 20: LIDAR of lidar: range_m is "));
  const auto verified = nlohmann::json::parse(run.out)["verified"];
  EXPECT_EQ(verified["same"], false);
  EXPECT_EQ(verified["first"]["role"], "lidar");
  EXPECT_EQ(verified["first"]["step"], 20);
  EXPECT_EQ(verified["first"]["field"], "range_m");
}

TEST_F(AlteredTrafficTest, EndsATableAlsoWhereStderrIsAFullDisk) {
  bridge_.Alter(20);
  const Background lidar({Program("fogline-lidar"), "--lcm-url", lidar_url_});
  Background table({"sh", "-c", "exec 2>/dev/full; exec \"$@\"", "sh", Program("fogline"), "table",
                    "scenario/paper.json", "--thresholds", "0.5", "--set", "/steps=50",
                    "--external", "lidar", "--lcm-url", url_});
  bridge_.RunUntilTheEndOf(table);
  EXPECT_EQ(table.Wait(), 1);
}

TEST_F(AlteredTrafficTest, IsNotLookedForOnRequest) {
  bridge_.Alter(20);
  const Outcome run = RunAcross(bridge_, {"--no-verify"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(nlohmann::json::parse(run.out)["verified"].is_null());
}

TEST_F(AlteredTrafficTest, IsNotFoundWhereNothingWasAltered) {
  const Outcome run = RunAcross(bridge_, {});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["verified"]["roles"].size(), kRoles.size() - 1);
}

}  // namespace
}  // namespace fogline::test
