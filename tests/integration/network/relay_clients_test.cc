// fogline-relay with clients that break the rules of the protocol or do not read.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "services/runtime/wire/tcpq_frame.h"
#include "tests/integration/network/relay_fixture.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

/// A plain TCP connection that sends arbitrary bytes.
class RawSocket {
 public:
  explicit RawSocket(std::uint16_t port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    // A call that takes longer than this time counts as blocked for ever.
    const timeval limit{.tv_sec = kPatience.count(), .tv_usec = 0};
    setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof(limit));
    setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  }
  ~RawSocket() { close(fd_); }
  RawSocket(const RawSocket&) = delete;
  RawSocket& operator=(const RawSocket&) = delete;

  /// Sends all bytes. The test fails if a call blocks. @return false if the other side has closed
  /// the connection
  bool Send(runtime::Bytes bytes) const {
    while (!bytes.empty()) {
      const ssize_t size = send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (size < 0) {
        EXPECT_NE(errno, EAGAIN) << "blocked";
        return false;
      }
      bytes = bytes.subspan(static_cast<std::size_t>(size));
    }
    return true;
  }
  /// Sends these bytes again and again, until the other side has accepted none of them for half a
  /// second, or until `most` bytes are sent. @return the number of bytes; 0 if the connection is
  /// lost
  std::size_t SendUntilFull(runtime::Bytes bytes, std::size_t most) const {
    std::size_t sent = 0;
    while (sent < most) {
      const runtime::Bytes rest = bytes.subspan(sent % bytes.size());
      const ssize_t size = send(fd_, rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (size > 0) sent += static_cast<std::size_t>(size);
      if (size > 0) continue;
      if (errno != EAGAIN) return 0;
      pollfd room{.fd = fd_, .events = POLLOUT, .revents = 0};
      if (poll(&room, 1, 500) == 0) break;
    }
    return sent;
  }
  /// Reads this number of bytes. @return false if the other side closes the connection earlier
  bool Read(std::size_t count) const {
    Payload bytes(1 << 16);
    while (count > 0) {
      const ssize_t size = recv(fd_, bytes.data(), std::min(count, bytes.size()), 0);
      if (size <= 0) return false;
      count -= static_cast<std::size_t>(size);
    }
    return true;
  }
  /// Reads until the other side closes the connection. @return false if the other side does not
  /// close it
  bool WaitForClose() const {
    Payload bytes(4096);
    ssize_t size = 0;
    while ((size = recv(fd_, bytes.data(), bytes.size(), 0)) > 0) {
    }
    return size == 0 || errno == ECONNRESET;
  }
  /// The name of this client in the relay's texts: "127.0.0.1:PORT".
  std::string Name() const {
    sockaddr_in address{};
    socklen_t size = sizeof(address);
    getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
    return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }

 private:
  int fd_;
};

Payload Greeting() {
  Payload bytes;
  runtime::tcpq::AppendHello(runtime::tcpq::kClientMagic, bytes);
  return bytes;
}

Payload SubscriptionTo(std::string_view pattern) {
  Payload bytes = Greeting();
  runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kSubscribe, pattern, {}, bytes);
  return bytes;
}

Payload Message(std::string_view channel, const Payload& payload) {
  Payload bytes;
  runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kPublish, channel, payload, bytes);
  return bytes;
}

TEST(HostileRelayClientTest, DisconnectsAndNamesAClientThatNeverReadsAndServesTheOthers) {
  Relay relay({"--max-queue", "4"});
  const RawSocket sleeper(relay.port());
  ASSERT_TRUE(sleeper.Send(SubscriptionTo(".*")));
  runtime::Bus bus(relay.url());
  int heard = 0;
  bus.Subscribe("DATA", [&heard](runtime::Bytes) { ++heard; });
  // WHEN more messages are published than the client's socket and queue can hold
  const Payload payload(runtime::kMaxMessageBytes, 1);
  constexpr int kMessages = 17'000;
  for (int i = 0; i < kMessages; ++i) {
    bus.Publish("DATA", payload);
    bus.Drain();
  }
  // THEN the other client gets all messages, and the relay names the client that does not read
  ASSERT_TRUE(RoundTrip(bus));
  EXPECT_EQ(heard, kMessages);
  EXPECT_TRUE(relay.process().WaitForErr("disconnected: does not read; "));
  EXPECT_THAT(relay.process().Err(), HasSubstr(sleeper.Name() + " disconnected"));
}

TEST(HostileRelayClientTest, DoesNotBlockWithAPublisherThatNeverReadsItsOwnMessages) {
  Relay relay({"--max-queue", "4"});
  const RawSocket publisher(relay.port());
  ASSERT_TRUE(publisher.Send(SubscriptionTo(".*")));
  // WHEN the publisher sends up to 100 MB and reads nothing. (The test fails if Send() blocks)
  const Payload message = Message("ECHO", Payload(100'000));
  int sent = 0;
  while (sent < 1000 && publisher.Send(message)) ++sent;
  // THEN the relay disconnects the publisher before all messages are sent
  EXPECT_LT(sent, 1000);
  EXPECT_TRUE(relay.process().WaitForErr(publisher.Name() + " disconnected: does not read; "));
}

TEST(HostileRelayClientTest, IsWaitedForIfItReadsAfterItHasPublished) {
  Relay relay({"--max-queue", "4"});
  const RawSocket publisher(relay.port());
  ASSERT_TRUE(publisher.Send(SubscriptionTo("ECHO")));
  // WHEN the publisher sends without reading, until the relay accepts nothing more
  constexpr std::size_t kMost = 200'000'000;
  const Payload message = Message("ECHO", Payload(1000));
  const std::size_t sent = publisher.SendUntilFull(message, kMost);
  ASSERT_GT(sent, 0U) << relay.process().Err();
  EXPECT_LT(sent, kMost);
  // THEN every message comes back
  const std::size_t back = sent / message.size() * message.size();
  EXPECT_TRUE(publisher.Read(Greeting().size() + back)) << relay.process().Err();
  EXPECT_EQ(relay.process().Err(), "");
}

TEST(HostileRelayClientTest, DisconnectsAClientThatSendsGarbageAndNamesTheReason) {
  Relay relay({"--max-subscriptions", "2", "--max-message", "1"});
  runtime::Bus bus(relay.url());
  const std::string http = "GET / HTTP/1.1\r\n\r\n";
  Payload subscriptions = Greeting();
  for (const char* pattern : {"A", "B", "C"}) {
    runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kSubscribe, pattern, {}, subscriptions);
  }
  Payload oversized = Greeting();
  runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kPublish, "BIG", Payload((1 << 20) + 1),
                             oversized);
  Payload unknown = Greeting();
  runtime::tcpq::AppendFrame(runtime::tcpq::FrameType{9}, "A", {}, unknown);
  const std::vector<std::pair<Payload, std::string>> cases{
      {Payload(http.begin(), http.end()), "begins with 0x47455420"},
      {unknown, "frame of unknown type 9"},
      {oversized, "message of 1048577 bytes on \"BIG\"; at most 1048576"},
      {SubscriptionTo(std::string(2000, 'a')), "pattern of 2000 bytes; at most 256"},
      {SubscriptionTo("("), "a subscription that is no regular expression"},
      {subscriptions, "more than 2 subscriptions"},
  };
  for (const auto& [bytes, reason] : cases) {
    const RawSocket client(relay.port());
    client.Send(bytes);
    EXPECT_TRUE(client.WaitForClose()) << reason;
    EXPECT_TRUE(relay.process().WaitForErr(client.Name() + " disconnected: " + reason))
        << reason << "\n"
        << relay.process().Err();
  }
  // The other client was not disturbed.
  EXPECT_TRUE(RoundTrip(bus));
  ASSERT_EQ(relay.End(), 0);
  EXPECT_THAT(relay.process().Err(), HasSubstr("6 disconnected; "));
}

TEST(HostileRelayClientTest, DisconnectsAConnectionThatNeverSaysThatItIsAClient) {
  Relay relay;
  const RawSocket silent(relay.port());
  EXPECT_TRUE(silent.WaitForClose());
  EXPECT_TRUE(relay.process().WaitForErr(silent.Name() + " disconnected: has not said in 5 s"));
}

TEST(HostileRelayClientTest, TakesNoMoreClientsThanItMay) {
  Relay relay({"--max-clients", "1"});
  runtime::Bus bus(relay.url());
  const RawSocket second(relay.port());
  EXPECT_TRUE(second.WaitForClose());
  EXPECT_TRUE(relay.process().WaitForErr(second.Name() + " disconnected: 1 clients are connected"));
  EXPECT_TRUE(RoundTrip(bus));
}

TEST(HostileRelayClientTest, IsCutOffWhenItsExpressionsAreSlowOnEverNewNames) {
  Relay relay;
  // GIVEN a client that subscribes with a regular expression. The search for this expression is
  // slow in some channel names. The relay's library, Boost, limits the steps of a search. But this
  // limit is high here, because the expression is long. Another client subscribes to everything
  const RawSocket slow(relay.port());
  ASSERT_TRUE(slow.Send(SubscriptionTo("(a|aa)+b" + std::string(240, 'c'))));
  runtime::Bus bus(relay.url());
  int heard = 0;
  bus.Subscribe("LAST", [&heard](runtime::Bytes) { ++heard; });
  const RawSocket sleeper(relay.port());
  ASSERT_TRUE(sleeper.Send(SubscriptionTo(".*")));
  // WHEN a third client publishes on more and more channels with such names
  constexpr int kNames = 5000;
  for (int i = 0; i < kNames; ++i)
    bus.Publish(std::string(20, 'a') + std::to_string(i), Payload(1));
  // THEN the relay disconnects only the first client, and names it
  ASSERT_TRUE(RoundTrip(bus));
  EXPECT_TRUE(slow.WaitForClose());
  EXPECT_TRUE(
      relay.process().WaitForErr(slow.Name() + " disconnected: its subscriptions take too long"));
  ASSERT_EQ(relay.End(), 0);
  EXPECT_THAT(relay.process().Err(), HasSubstr(" 1 disconnected; "));
}

}  // namespace
}  // namespace fogline::test
