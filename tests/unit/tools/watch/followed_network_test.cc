#include "tools/watch/followed_network.h"

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <thread>

namespace fogline::watch {
namespace {

constexpr Duration kPatience = milliseconds(20'000);
const std::vector<std::uint8_t> kBytes(100, 1);

/// Handles what comes until `done()` is true. @return whether it is
template <class Done>
bool HandleUntil(FollowedNetwork& network, const Done& done) {
  const TimePoint end = Clock::now() + kPatience;
  while (!done() && Clock::now() < end) network.Handle(Clock::now());
  return done();
}

TEST(FollowedNetworkTest, CountsItsOwnGapAsNoLoss) {
  const std::string url = runtime::FreshMulticastUrl();
  std::int64_t heard = 0;
  FollowedNetwork network(url, false, [&](std::string_view, runtime::Bytes) { ++heard; });
  std::atomic<std::int64_t> sent = 0;
  std::jthread sender([&](const std::stop_token& stop) {
    runtime::Bus bus(url);
    while (!stop.stop_requested()) {
      bus.Publish("TEST", kBytes);
      ++sent;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  ASSERT_TRUE(HandleUntil(network, [&] { return heard > 0; }));
  for (std::int64_t unknown = 10'000; unknown <= 50'000; unknown += 10'000) {
    network.ForgetNames(unknown);
    const std::int64_t before = heard;
    ASSERT_TRUE(HandleUntil(network, [&] { return heard > before; }));
  }
  sender.request_stop();
  sender.join();
  const auto received = [&] {
    const auto view = network.ViewSenders(Clock::now());
    return view.senders.empty() ? 0 : view.senders[0].counts.received;
  };
  ASSERT_TRUE(HandleUntil(network, [&] { return received() >= sent; })) << received() << sent;
  EXPECT_LT(heard, sent);  // otherwise the test has met no gap
  EXPECT_EQ(network.ViewSenders(Clock::now()).senders[0].counts.lost, 0);
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
    FollowedNetwork network(url, false, [&](std::string_view, runtime::Bytes) { ++heard; });
    EXPECT_FALSE(network.numbered());
    EXPECT_NE(network.tap_trouble().find("cannot be counted"), std::string::npos);
    runtime::Bus(url).Publish("TEST", kBytes);
    EXPECT_TRUE(HandleUntil(network, [&] { return heard == 1; }));
  }).join();
}

}  // namespace
}  // namespace fogline::watch
