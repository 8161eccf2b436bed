#include "services/runtime/discovery/waiting_roles.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

namespace fogline::runtime {
namespace {

status_t Waiting(const std::string& role, std::int64_t instance) {
  status_t status{};
  status.role = role;
  status.host = "lab2";
  status.pid = 4711;
  status.instance = instance;
  status.version = "0.1.0";
  status.type_fingerprint = TypeFingerprint();
  status.waiting_for = "udpm://239.255.76.67:7700?ttl=1";
  status.waiting_ms = 2500;
  return status;
}

class WaitingRolesTest : public testing::Test {
 protected:
  void Hear(const status_t& status, TimePoint at) {
    std::vector<std::uint8_t> bytes;
    Encode(status, bytes);
    roles_.Hear(bytes, at);
  }

  WaitingRoles roles_;
  TimePoint now_ = Clock::now();
};

TEST_F(WaitingRolesTest, TellWhoWaitsWhereWithWhichVersion) {
  Hear(Waiting("driver", 1), now_);
  Hear(Waiting("radar", 2), now_);
  Hear(Waiting("driver", 1), now_);
  const std::vector<WaitingRole> current = roles_.Current(now_);
  ASSERT_EQ(current.size(), 2U);
  EXPECT_EQ(current[0].role, "radar") << "in the order of the graph";
  EXPECT_EQ(current[1].Text(),
            "driver waits on udpm://239.255.76.67:7700?ttl=1: pid 4711 on lab2, version 0.1.0");
  EXPECT_EQ(current[1].waiting_s, 2.5);
}

TEST_F(WaitingRolesTest, ForgetARoleThatSaysNothingMore) {
  Hear(Waiting("driver", 1), now_);
  EXPECT_EQ(roles_.Current(now_ + WaitingRoles::kGone).size(), 1U);
  EXPECT_EQ(roles_.Current(now_ + WaitingRoles::kGone + milliseconds(1)).size(), 0U);
}

TEST_F(WaitingRolesTest, NameARoleOfOtherTypesAndCountWhatIsNoStatus) {
  status_t other = Waiting("driver", 1);
  ++other.type_fingerprint;
  Hear(other, now_);
  EXPECT_THAT(roles_.Current(now_)[0].Text(),
              testing::EndsWith(", built with other message types"));
  roles_.Hear(std::vector<std::uint8_t>(500, 0xff), now_);
  roles_.Hear({}, now_);
  status_t negative = Waiting("acc", 2);
  negative.waiting_ms = -1;
  Hear(negative, now_);
  EXPECT_EQ(roles_.undecodable(), 3);
}

TEST_F(WaitingRolesTest, AreSafeToPrintAndBounded) {
  status_t wild = Waiting("\033[2J", 1);
  wild.host = std::string(300, 'x');
  Hear(wild, now_);
  ASSERT_EQ(roles_.Current(now_).size(), 1U);
  EXPECT_EQ(roles_.Current(now_)[0].role, "?[2J");
  EXPECT_LE(roles_.Current(now_)[0].host.size(), 200U);
  for (std::int64_t i = 0; i < 1000; ++i) Hear(Waiting("driver", 10 + i), now_);
  EXPECT_EQ(roles_.Current(now_).size(), WaitingRoles::kMax);
}

}  // namespace
}  // namespace fogline::runtime
