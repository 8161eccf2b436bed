#include "services/runtime/transport/udpm/backlog.h"

#include <gtest/gtest.h>

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>

#include "common/process/poll.h"

namespace fogline::runtime {
namespace {

constexpr std::size_t kMost = 100;
constexpr Duration kLong = std::chrono::seconds(5);

bool IsWanted(Bytes packet) { return packet[0] != 'x'; }

/// Two ends of a connection on which a sender waits while the kernel's buffer is full.
class Ends {
 public:
  Ends() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends_.data()), 0); }
  ~Ends() {
    close(ends_[0]);
    close(ends_[1]);
  }
  Ends(const Ends&) = delete;
  Ends& operator=(const Ends&) = delete;

  int receiver() const { return ends_[0]; }
  /// Sends a packet. @return whether the kernel had room for it before `timeout` was over
  bool Send(const std::string& packet, Duration timeout = kLong) const {
    return PollFor(ends_[1], POLLOUT, timeout) > 0 &&
           send(ends_[1], packet.data(), packet.size(), 0) == static_cast<ssize_t>(packet.size());
  }

 private:
  std::array<int, 2> ends_{};
};

/// The next packet; "" if none comes.
std::string Next(Backlog& backlog) {
  if (PollFor(backlog.fd(), POLLIN, kLong) <= 0) return "";
  const auto packet = backlog.Take();
  return packet ? std::string(packet->begin(), packet->end()) : "";
}

TEST(BacklogTest, KeepsMoreThanTheKernelInItsOrder) {
  const Ends ends;
  Backlog backlog(ends.receiver(), kMost, &IsWanted);
  constexpr int kPackets = 2000;
  // The test takes no packet yet, so without the backlog's thread the kernel's buffer would stay
  // full, and Send() would fail.
  for (int i = 0; i < kPackets; ++i) ASSERT_TRUE(ends.Send("packet " + std::to_string(i)));
  for (int i = 0; i < kPackets; ++i) ASSERT_EQ(Next(backlog), "packet " + std::to_string(i));
  EXPECT_FALSE(backlog.Take());
  EXPECT_EQ(PollFor(backlog.fd(), POLLIN, Duration::zero()), 0);
}

TEST(BacklogTest, DropsWhatIsTooLongOrNotWanted) {
  const Ends ends;
  Backlog backlog(ends.receiver(), kMost, &IsWanted);
  for (const std::string& packet :
       {std::string(kMost + 1, 'a'), std::string("x"), std::string(kMost, 'b')}) {
    ASSERT_TRUE(ends.Send(packet));
  }
  EXPECT_EQ(Next(backlog), std::string(kMost, 'b'));
  EXPECT_FALSE(backlog.Take());
}

TEST(BacklogTest, LeavesInTheKernelWhatIsBeyondItsCapacity) {
  const Ends ends;
  Backlog backlog(ends.receiver(), kMost, &IsWanted, 1000);
  int sent = 0;
  while (sent < 1000 && ends.Send("packet " + std::to_string(sent), milliseconds(500))) ++sent;
  EXPECT_LT(sent, 1000);
  for (int i = 0; i < sent; ++i) ASSERT_EQ(Next(backlog), "packet " + std::to_string(i));
  ASSERT_TRUE(ends.Send("last"));
  EXPECT_EQ(Next(backlog), "last");
}

TEST(BacklogTest, EndsWhileItIsFullAndWhileItWaits) {
  const Ends ends;
  {
    Backlog waiting(ends.receiver(), kMost, &IsWanted);
    ASSERT_TRUE(ends.Send("packet"));
    EXPECT_EQ(Next(waiting), "packet");
    std::this_thread::sleep_for(milliseconds(50));  // now the thread waits for the next packet
  }
  {
    const Backlog full(ends.receiver(), kMost, &IsWanted, 1);
    int sent = 0;
    while (sent < 1000 && ends.Send("packet", milliseconds(200))) ++sent;
    EXPECT_LT(sent, 1000);
  }
}

}  // namespace
}  // namespace fogline::runtime
