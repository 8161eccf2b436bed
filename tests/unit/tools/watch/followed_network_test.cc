#include "tools/watch/followed_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "services/runtime/discovery/beacon.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/environment_url.h"

namespace fogline::watch {
namespace {

using ::testing::ElementsAre;

constexpr Duration kPatience = milliseconds(20'000);
const std::vector<std::uint8_t> kBytes(100, 1);

/// Handles messages until `done()` is true, or until kPatience has passed. @return whether `done()`
/// is true
template <class Done>
bool HandleUntil(FollowedNetwork& network, const Done& done) {
  const TimePoint end = Clock::now() + kPatience;
  while (!done() && Clock::now() < end) network.Handle(Clock::now());
  return done();
}

TEST(FollowedNetworkTest, ForgetsTheNamesThatLcmKeeps) {
  const std::string url = runtime::FreshMulticastUrl();
  for (const bool lcm_receives : {false, true}) {
    std::int64_t heard = 0;
    FollowedNetwork network(lcm_receives ? "mp" + url : url, Following::kNothing,
                            [&](std::string_view, runtime::Bytes) { ++heard; });
    const std::int64_t generation = network.generation();
    network.ForgetNames(9'999);
    EXPECT_EQ(network.generation(), generation);
    network.ForgetNames(10'000);
    EXPECT_EQ(network.generation() != generation, lcm_receives);
    // With mpudpm, LCM may lose the first messages, while it learns the port of their channel. So
    // the test sends until a message is heard.
    runtime::Bus sender(network.url());
    EXPECT_TRUE(HandleUntil(network, [&] {
      sender.Publish("TEST", kBytes);
      std::this_thread::sleep_for(milliseconds(10));
      return heard > 0;
    })) << network.url();
  }
}

/// Two runs that are announced, one after the other.
class FollowedRunTest : public ::testing::Test {
 protected:
  FollowedRunTest() { environment_.Set(meeting_); }  // beacons go there

  /// Handles messages until `done()` is true, and announces the runs that have not ended.
  template <class Done>
  void KeepOnUntil(const Done& done) {
    ASSERT_TRUE(HandleUntil(*network_, [&] {
      for (std::optional<runtime::Beacon>* beacon : {&first_, &second_}) {
        if (*beacon && (*beacon)->Due(Clock::now())) (*beacon)->Send(Clock::now(), {});
      }
      return done();
    }));
  }
  /// Follows the first run, and announces the second one.
  void FollowTwo(Following following) {
    network_.emplace(meeting_, following, [](std::string_view, runtime::Bytes) {});
    first_.emplace(runtime::Announcement{.run_id = 1, .url = first_url_});
    KeepOnUntil([this] { return network_->followed(); });
    EXPECT_EQ(network_->url(), first_url_);
    second_.emplace(runtime::Announcement{.run_id = 2, .url = second_url_});
    KeepOnUntil([this] { return network_->runs().size() == 2; });
  }
  /// Ends the first run, and waits until the network has heard of its end.
  void EndFirst() {
    runtime::BeaconListener listener(meeting_);
    const auto hears_first = [&listener] {
      listener.Look();
      const auto runs = listener.Runs();
      return std::ranges::find(runs, 1, &runtime::Announcement::run_id) != runs.end();
    };
    KeepOnUntil(hears_first);
    first_.reset();
    KeepOnUntil([&hears_first] { return !hears_first(); });
    network_->Handle(Clock::now() + milliseconds(100));  // the network looks every 100 ms
  }
  std::vector<std::int64_t> Runs() const {
    std::vector<std::int64_t> ids;
    for (const runtime::Announcement& run : network_->runs()) ids.push_back(run.run_id);
    return ids;
  }

  const test::EnvironmentUrl environment_;
  const std::string meeting_ = runtime::FreshMulticastUrl();
  const std::string first_url_ = runtime::FreshMulticastUrl();
  const std::string second_url_ = runtime::FreshMulticastUrl();
  std::optional<runtime::Beacon> first_;
  std::optional<runtime::Beacon> second_;
  std::optional<FollowedNetwork> network_;
};

TEST_F(FollowedRunTest, FollowsTheNewestRun) {
  FollowTwo(Following::kNewestRun);
  EXPECT_EQ(network_->url(), second_url_);
  EXPECT_THAT(Runs(), ElementsAre(2, 1));
  EndFirst();
  EXPECT_EQ(network_->url(), second_url_);
  EXPECT_THAT(Runs(), ElementsAre(2));
}

TEST_F(FollowedRunTest, StaysWithTheFirstRunAlsoAfterItsEnd) {
  FollowTwo(Following::kFirstRun);
  EXPECT_EQ(network_->url(), first_url_);
  EXPECT_THAT(Runs(), ElementsAre(1, 2));
  EndFirst();
  EXPECT_TRUE(network_->followed());
  EXPECT_EQ(network_->url(), first_url_);
  EXPECT_THAT(Runs(), ElementsAre(1, 2));
}

TEST_F(FollowedRunTest, IsTheNewestOfTheRunsThatHaveAnnouncedThemselves) {
  const TimePoint began = Clock::now();
  network_.emplace(meeting_, Following::kFirstRun, [](std::string_view, runtime::Bytes) {});
  first_.emplace(runtime::Announcement{.run_id = 1, .url = first_url_});
  first_->Send(Clock::now(), {});
  network_->Handle(began + milliseconds(200));
  EXPECT_FALSE(network_->followed());
  second_.emplace(runtime::Announcement{.run_id = 2, .url = second_url_});
  KeepOnUntil([this] { return network_->followed(); });
  EXPECT_EQ(network_->url(), second_url_);
}

/// From now on the kernel refuses SO_RXQ_OVFL to this thread, as a kernel without this option does.
void RefuseOverflowCounts() {
  std::array program{
      sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_setsockopt, 0, 3),
      sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[2])),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SO_RXQ_OVFL, 0, 1),
      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOPROTOOPT),
      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
  const sock_fprog filter{.len = program.size(), .filter = program.data()};
  ASSERT_EQ(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), 0);
  ASSERT_EQ(syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &filter), 0);
}

TEST(FollowedNetworkTest, ShowsMessagesWhosePacketsItCannotCount) {
  std::thread([] {
    ASSERT_NO_FATAL_FAILURE(RefuseOverflowCounts());
    const std::string url = runtime::FreshMulticastUrl();
    std::int64_t heard = 0;
    FollowedNetwork network(url, Following::kNothing,
                            [&](std::string_view, runtime::Bytes) { ++heard; });
    EXPECT_FALSE(network.numbered());
    EXPECT_NE(network.tap_trouble().find("cannot be counted"), std::string::npos);
    runtime::Bus(url).Publish("TEST", kBytes);
    EXPECT_TRUE(HandleUntil(network, [&] { return heard == 1; }));
  }).join();
}

}  // namespace
}  // namespace fogline::watch
