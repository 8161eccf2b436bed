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

#include "services/runtime/transport/udpm/fresh_url.h"

namespace fogline::watch {
namespace {

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
    FollowedNetwork network(lcm_receives ? "mp" + url : url, false,
                            [&](std::string_view, runtime::Bytes) { ++heard; });
    const std::int64_t generation = network.generation();
    network.ForgetNames(9'999);
    EXPECT_EQ(network.generation(), generation);
    network.ForgetNames(10'000);
    EXPECT_EQ(network.generation() != generation, lcm_receives);
    // LCM may lose the first messages of mpudpm, while it learns the port of their channel.
    runtime::Bus sender(network.url());
    EXPECT_TRUE(HandleUntil(network, [&] {
      sender.Publish("TEST", kBytes);
      std::this_thread::sleep_for(milliseconds(10));
      return heard > 0;
    })) << network.url();
  }
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
