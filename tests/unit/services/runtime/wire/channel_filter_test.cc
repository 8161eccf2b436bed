#include "services/runtime/wire/channel_filter.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "services/runtime/transport/bus.h"

namespace fogline {
namespace {

using namespace std::string_literals;

/// An LCM datagram with a whole message.
std::string Datagram(const std::string& channel, const std::string& data = "12345678") {
  return "LC02\0\0\0\7"s + channel + '\0' + data;
}

/// A receiving socket behind a filter, and a socket that sends to it.
class FilteredSocket {
 public:
  explicit FilteredSocket(const std::vector<runtime::Wanted>& wanted)
      : FilteredSocket(runtime::ChannelFilter(wanted)) {}
  explicit FilteredSocket(const std::vector<sock_filter>& filter) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* where = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(receiver_, where, size), 0);
    EXPECT_EQ(getsockname(receiver_, where, &size), 0);
    EXPECT_EQ(connect(sender_, where, size), 0);
    EXPECT_TRUE(runtime::AttachFilter(receiver_, filter));
  }
  ~FilteredSocket() {
    close(receiver_);
    close(sender_);
  }
  FilteredSocket(const FilteredSocket&) = delete;
  FilteredSocket& operator=(const FilteredSocket&) = delete;

  int receiver() const { return receiver_; }
  void Send(const std::string& datagram) const {
    ASSERT_EQ(send(sender_, datagram.data(), datagram.size(), 0),
              static_cast<ssize_t>(datagram.size()));
  }
  /// The next datagram that passes the filter.
  std::string Receive() const {
    std::array<char, 70'000> buffer{};
    const ssize_t size = recv(receiver_, buffer.data(), buffer.size(), 0);
    return size < 0 ? "nothing" : std::string(buffer.data(), static_cast<std::size_t>(size));
  }

 private:
  int receiver_ = socket(AF_INET, SOCK_DGRAM, 0);
  int sender_ = socket(AF_INET, SOCK_DGRAM, 0);
};

TEST(ChannelFilterTest, TakesWhatIsSubscribedWholeAndInOrder) {
  const std::vector<std::string> channels{"FOLLOWER_COMMAND", "A", "TRUTH", "RUN", "RADAR", "AB"};
  std::vector<runtime::Wanted> wanted;
  for (const std::string& channel : channels) wanted.push_back({channel});
  const FilteredSocket socket(wanted);
  for (const std::string& channel : channels) socket.Send(Datagram(channel));
  for (const std::string& channel : channels) EXPECT_EQ(socket.Receive(), Datagram(channel));
}

TEST(ChannelFilterTest, TakesAMessageWithoutData) {
  // GIVEN two wanted channels, one of them with a name that is longer than the whole datagram
  const FilteredSocket socket({{"RUN_OF_LONGER_NAME"}, {"RUN"}});
  socket.Send(Datagram("RUN", ""));
  EXPECT_EQ(socket.Receive(), Datagram("RUN", ""));
}

TEST(ChannelFilterTest, DropsEveryOtherChannel) {
  const FilteredSocket socket({{"RADAR"}, {"TRUTH"}});
  for (const char* other :
       {"RADA", "RADAR2", "TRUT", "TRUTHS", "radar", "LIDAR", "", "RADAR TRUTH"}) {
    socket.Send(Datagram(other));
  }
  socket.Send(Datagram("TRUTH"));
  EXPECT_EQ(socket.Receive(), Datagram("TRUTH"));
}

TEST(ChannelFilterTest, DropsWhateverIsNoMessageInOneDatagram) {
  const FilteredSocket socket({{"RADAR"}});
  socket.Send("LC03\0\0\0\7RADAR\0 a fragment"s);
  socket.Send("LC01\0\0\0\7RADAR\0 of an old version"s);
  for (const std::string& noise : {""s, "L"s, "LC02"s, "LC02\0\0\0\7"s, "LC02\0\0\0\7RADAR"s}) {
    socket.Send(noise);
  }
  socket.Send(Datagram("RADAR"));
  EXPECT_EQ(socket.Receive(), Datagram("RADAR"));
}

TEST(ChannelFilterTest, TakesOfAChannelWhatHasAWantedTextAtItsPlace) {
  const FilteredSocket socket({{"RESEND", {.offset = 4, .texts = {"TRUTH", "EGO"}}}, {"RUN"}});
  for (const char* other : {"", "1234", "1234TRUT", "12345TRUTH", "TRUTH", "1234RADAR"}) {
    socket.Send(Datagram("RESEND", other));
  }
  for (const char* wanted : {"1234TRUTH", "1234EGO and more"}) {
    socket.Send(Datagram("RESEND", wanted));
    EXPECT_EQ(socket.Receive(), Datagram("RESEND", wanted));
  }
  socket.Send(Datagram("RUN", "any"));
  EXPECT_EQ(socket.Receive(), Datagram("RUN", "any"));
}

TEST(ChannelFilterTest, TakesAShareOfAChannelAtRandom) {
  const FilteredSocket socket({{.channel = "RESEND", .share = 0.25}, {.channel = "RUN"}});
  constexpr int kSent = 400;
  int taken = 0;
  for (int i = 0; i < kSent; ++i) {
    socket.Send(Datagram("RESEND"));
    socket.Send(Datagram("RUN"));
    if (socket.Receive() == Datagram("RESEND")) {
      ++taken;
      EXPECT_EQ(socket.Receive(), Datagram("RUN"));
    }
  }
  // The tolerance is five standard deviations of a binomial distribution.
  EXPECT_NEAR(taken, 0.25 * kSent, 5 * std::sqrt(kSent * 0.25 * 0.75));
}

TEST(ChannelFilterTest, DropsEverythingWithoutChannels) {
  const FilteredSocket socket(runtime::ChannelFilter({}));
  socket.Send(Datagram("RADAR"));
  ASSERT_TRUE(runtime::AttachFilter(socket.receiver(), runtime::ChannelFilter({{"LIDAR"}})));
  socket.Send(Datagram("LIDAR"));
  EXPECT_EQ(socket.Receive(), Datagram("LIDAR"));
}

TEST(ChannelFilterTest, DropsWhatIsLargerThanAnyMessage) {
  const FilteredSocket socket({{"RADAR"}});
  const std::string largest =
      Datagram("RADAR", std::string(runtime::kMaxMessageBytes + runtime::kSignatureBytes, 'x'));
  socket.Send(Datagram("RADAR", std::string(2000, 'x')));
  socket.Send(Datagram("RADAR", std::string(60'000, 'x')));
  socket.Send(largest);
  EXPECT_EQ(socket.Receive(), largest);
}

TEST(ChannelFilterTest, RefusesToJumpFurtherThanTheKernelCan) {
  std::vector<std::string> texts;
  for (int i = 0; i < 200; ++i) texts.push_back(std::to_string(i));
  EXPECT_THROW(runtime::ChannelFilter({{"RESEND", {.offset = 4, .texts = texts}}}),
               std::logic_error);
}

TEST(AnyChannelFilterTest, TakesEveryWholeMessageWithANameThatEnds) {
  const FilteredSocket socket(runtime::AnyChannelFilter());
  const std::string longest_name(63, 'N');
  const std::vector<std::string> good{
      Datagram("RADAR"), Datagram(""), Datagram("A", ""), Datagram(longest_name),
      Datagram(longest_name,
               std::string(runtime::kMaxMessageBytes + runtime::kSignatureBytes, 'x'))};
  for (const std::string& datagram : good) socket.Send(datagram);
  for (const std::string& datagram : good) EXPECT_EQ(socket.Receive(), datagram);
}

TEST(AnyChannelFilterTest, DropsFragmentsAndWhateverIsNoMessageInOneDatagram) {
  const FilteredSocket socket(runtime::AnyChannelFilter());
  for (const std::string& noise :
       {"LC03\0\0\0\7\0\0\0\x10\0\0\0\0\0\0\0\1RADAR\0 a fragment"s, "LC01\0\0\0\7RADAR\0"s, ""s,
        "LC02"s, "LC02\0\0\0\7"s, "LC02\0\0\0\7no end"s, Datagram(std::string(64, 'N')),
        Datagram("RADAR", std::string(2000, 'x')), Datagram("RADAR", std::string(60'000, 'x'))}) {
    socket.Send(noise);
  }
  socket.Send(Datagram("RADAR"));
  EXPECT_EQ(socket.Receive(), Datagram("RADAR"));
}

TEST(AttachFilterTest, SaysThatTheKernelWillNot) {
  const FilteredSocket socket({{"RADAR"}});
  const int locked = 1;
  ASSERT_EQ(setsockopt(socket.receiver(), SOL_SOCKET, SO_LOCK_FILTER, &locked, sizeof(locked)), 0);
  EXPECT_FALSE(runtime::AttachFilter(socket.receiver(), runtime::ChannelFilter({})));
  EXPECT_FALSE(runtime::AttachFilter(-1, runtime::ChannelFilter({})));
}

TEST(AttachFilterTest, RefusesAProgramLongerThanTheKernelTakes) {
  std::vector<runtime::Wanted> many;
  for (int i = 0; i < 2000; ++i) many.push_back({std::to_string(i)});
  EXPECT_THROW((void)runtime::AttachFilter(-1, runtime::ChannelFilter(many)), std::logic_error);
}

}  // namespace
}  // namespace fogline
