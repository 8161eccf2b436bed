// The limits of docs/view.md, one test for each limit. The server closes a connection that exceeds
// a limit, counts it, names it on stderr, and goes on. The tests set shorter time limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>

#include "common/clock.h"
#include "tests/support/command.h"
#include "tests/support/web_client.h"
#include "tools/web/server/server.h"

namespace fogline::web {
namespace {

using boost::asio::ip::tcp;
using test::Exchange;
using test::GetRequest;
using test::StatusOf;
using test::WebClient;
using ::testing::HasSubstr;

constexpr Duration kPatience = milliseconds(20'000);
// A short time limit of the server. Other clients need less time than this, also on a busy machine.
constexpr std::chrono::milliseconds kShort(2000);

/// Sends each frame back. To the frame "flood", the view answers with more bytes than may wait for
/// a client.
class EchoView final : public View {
 public:
  void Opened(Client&) override {}
  void Received(Client& client, std::string_view bytes, bool) override {
    if (bytes == "wrong") client.CountWrongFrame("as the test says");
    if (bytes == "end") {
      for (const char* word : {"one", "two", "three"}) client.Send(TextFrame(word));
      return end();
    }
    if (bytes != "flood") return client.Send(TextFrame(std::string(bytes)));
    for (int i = 0; i < 32; ++i) client.Send(TextFrame(std::string(1 << 20, 'x')));
  }
  void Idle(Client&) override {}
  void Closed(Client&) override {}

  std::function<void()> end;  // called after the frame "end"
};

/// A server in a thread of its own. stderr is captured.
class ServerLimitsTest : public ::testing::Test {
 protected:
  void Serve(const ServerLimits& limits, const std::string& address = "127.0.0.1",
             bool seat = false) {
    ::testing::internal::CaptureStderr();
    // poll() executes a handler that the previous server may have left in the context.
    context_.restart();
    context_.poll();
    context_.restart();
    server_.emplace(
        context_, ServerOptions{.address = address, .origins = {}, .limits = limits, .seat = seat},
        assets_, view_);
    thread_ = std::thread([this] { context_.run(); });
  }
  void TearDown() override { End(); }

  /// Ends the server. @return the text that the server has printed on stderr
  std::string End() {
    if (!thread_.joinable()) return "";
    boost::asio::post(context_, [this] { server_->Stop(); });
    thread_.join();
    return ::testing::internal::GetCapturedStderr();
  }
  std::uint16_t port() const { return server_->access().rules().port; }
  ServerCounts Counts() {
    std::promise<ServerCounts> counts;
    boost::asio::post(context_, [&] { counts.set_value(server_->counts()); });
    return counts.get_future().get();
  }
  /// Waits until a count has this value. @return false if the count does not reach the value in
  /// time
  bool Waits(std::int64_t ServerCounts::*count, std::int64_t value) {
    const TimePoint end = Clock::now() + kPatience;
    while (Counts().*count != value && Clock::now() < end) {
      std::this_thread::sleep_for(test::kLookEvery);
    }
    return Counts().*count == value;
  }
  /// A connection that sends nothing. @param host the client's own address
  tcp::socket Connect(const std::string& host = "127.0.0.1") {
    tcp::socket socket(own_);
    socket.open(tcp::v4());
    socket.set_option(boost::asio::socket_base::receive_buffer_size(4096));
    socket.bind({boost::asio::ip::make_address(host), 0});
    socket.connect({boost::asio::ip::address_v4::loopback(), port()});
    return socket;
  }
  /// A connection that has opened a WebSocket.
  tcp::socket Open() {
    tcp::socket socket = Connect();
    const std::string request =
        GetRequest(port(), "/ws",
                   "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                   "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n");
    boost::asio::write(socket, boost::asio::buffer(request));
    std::string answer;
    boost::asio::read_until(socket, boost::asio::dynamic_buffer(answer), "\r\n\r\n");
    EXPECT_EQ(StatusOf(answer), 101);
    return socket;
  }
  /// Waits until the server closes a connection. @return whether it does
  static bool IsClosed(tcp::socket& socket) {
    boost::system::error_code error;
    socket.non_blocking(true);
    char byte = 0;
    const TimePoint end = Clock::now() + kPatience;
    while (Clock::now() < end) {
      socket.read_some(boost::asio::buffer(&byte, 1), error);
      if (error && error != boost::asio::error::would_block) return true;
      std::this_thread::sleep_for(test::kLookEvery);
    }
    return false;
  }
  void ExpectServes() {
    WebClient client(port());
    client.Send("still there");
    EXPECT_EQ(client.Receive().bytes, "still there");
  }

  const std::string large_ = std::string(16 << 20, 'x');
  const std::array<Asset, 4> assets_{
      Asset{"/drive.html", "text/html; charset=utf-8", "\"e3\"", "<p>"},
      Asset{"/drive.js", "text/javascript", "\"e4\"", ";"},
      Asset{"/index.html", "text/html; charset=utf-8", "\"e1\"", "<p>"},
      Asset{"/large", "text/plain", "\"e2\"", large_}};

  boost::asio::io_context own_;
  boost::asio::io_context context_;
  EchoView view_;
  std::optional<Server> server_;
  std::thread thread_;
};

TEST_F(ServerLimitsTest, Viewers) {
  Serve({.viewers = 2});
  std::optional<WebClient> first(port());
  WebClient second(port());
  ASSERT_TRUE(Waits(&ServerCounts::viewers, 2));
  try {
    WebClient third(port());
    ADD_FAILURE() << "a third viewer has a place";
  } catch (const test::WebRefused& refused) {
    EXPECT_EQ(refused.status(), 503);
  }
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/"))), 503);
  EXPECT_EQ(Counts().refused, 2);
  first.reset();
  ASSERT_TRUE(Waits(&ServerCounts::viewers, 1));
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("refused: 2 viewers are connected already"));
}

TEST_F(ServerLimitsTest, ViewersLeaveAPlaceForTheOneWhoDrives) {
  Serve({.viewers = 2}, "127.0.0.1", true);
  const auto connect = [this](const char* protocol) {
    return WebClient(port(), {.protocol = protocol});
  };
  std::optional<WebClient> first(connect("fogline.view.v1"));
  WebClient second = connect("fogline.view.v1");
  ASSERT_TRUE(Waits(&ServerCounts::viewers, 2));
  // Although all places of viewers are taken, the server sends the page of the driver (/drive) and
  // its files. It refuses the page of the viewers (/).
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/drive"))), 200);
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/drive.js"))), 200);
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/"))), 503);
  {
    WebClient driver = connect("fogline.drive.v1");
    driver.Send("drives");
    EXPECT_EQ(driver.Receive().bytes, "drives");
    // There is one place for the driver, and a viewer does not get this place.
    EXPECT_THROW(connect("fogline.drive.v1"), test::WebRefused);
    EXPECT_THROW(connect("fogline.view.v1"), test::WebRefused);
    // The page can be loaded again, before its old connection is closed.
    EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/drive"))), 200);
    first.reset();
    ASSERT_TRUE(Waits(&ServerCounts::viewers, 2));
    WebClient another = connect("fogline.view.v1");
    EXPECT_THROW(connect("fogline.view.v1"), test::WebRefused);
  }
  ASSERT_TRUE(Waits(&ServerCounts::drivers, 0));
  ASSERT_TRUE(Waits(&ServerCounts::viewers, 1));
  // Of two pages that ask for the seat, the first takes the reserved place, and the second takes
  // the place of a viewer.
  WebClient driver = connect("fogline.drive.v1");
  WebClient told = connect("fogline.drive.v1");
  EXPECT_THROW(connect("fogline.view.v1"), test::WebRefused);
  EXPECT_EQ(Counts().drivers, 2);
}

TEST_F(ServerLimitsTest, CallersOfOneAddress) {
  Serve({.callers_of_one = 2}, "0.0.0.0");
  tcp::socket other = Connect("127.0.0.2");
  tcp::socket oldest = Connect();
  tcp::socket newer = Connect();
  tcp::socket newest = Connect();
  EXPECT_TRUE(IsClosed(oldest));
  EXPECT_EQ(Counts().refused, 1);
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/"))), 200);
  EXPECT_EQ(Counts().refused, 2);  // the connection `newer`
  // The callers of another address keep their places.
  const std::string request = GetRequest(port(), "/");
  boost::asio::write(other, boost::asio::buffer(request));
  std::string answer(12, ' ');
  boost::asio::read(other, boost::asio::buffer(answer));
  EXPECT_EQ(answer, "HTTP/1.1 200");
  EXPECT_THAT(End(), HasSubstr("refused: opens no view, and others want its place"));
}

TEST_F(ServerLimitsTest, CallersInAll) {
  Serve({.callers = 3, .callers_of_one = 2}, "0.0.0.0");
  tcp::socket other = Connect("127.0.0.2");
  tcp::socket oldest = Connect("127.0.0.3");
  tcp::socket newer = Connect("127.0.0.3");
  tcp::socket newest = Connect("127.0.0.4");
  EXPECT_TRUE(IsClosed(oldest));
  EXPECT_EQ(Counts().refused, 1);
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("127.0.0.3:"));
}

TEST_F(ServerLimitsTest, HeadersOfARequest) {
  Serve({});
  const std::string lines = "X-Long: " + std::string(9000, 'x') + "\r\n";
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/", lines))), 431);
  EXPECT_EQ(Counts().refused, 1);
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("refused: sends more than 8 KiB of headers"));
}

TEST_F(ServerLimitsTest, TimeForARequest) {
  Serve({.request = kShort});
  tcp::socket idle = Connect();
  EXPECT_TRUE(IsClosed(idle));
  EXPECT_EQ(Counts().refused, 1);
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("refused: sends no request within 2 s"));
}

TEST_F(ServerLimitsTest, TimeToTakeAnAnswer) {
  Serve({.request = kShort});
  tcp::socket lazy = Connect();
  boost::asio::write(lazy, boost::asio::buffer(GetRequest(port(), "/large")));
  EXPECT_TRUE(Waits(&ServerCounts::refused, 1));
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("refused: does not take its answer within 2 s"));
}

TEST_F(ServerLimitsTest, BytesThatWaitForAClient) {
  Serve({});
  WebClient client(port(), {.receive_bytes = 4096});
  client.Send("flood");
  EXPECT_TRUE(Waits(&ServerCounts::cut_off, 1));
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("cut off: does not read; "));
}

TEST_F(ServerLimitsTest, FrameOfAClient) {
  Serve({});
  WebClient client(port());
  client.Send(std::string(Server::kMostFrameBytes, 'x'));
  EXPECT_EQ(client.Receive().bytes.size(), Server::kMostFrameBytes);
  client.Send(std::string(Server::kMostFrameBytes + 1, 'x'));
  EXPECT_THROW(client.Receive(), test::WebClosed);
  EXPECT_TRUE(Waits(&ServerCounts::cut_off, 1));
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("cut off: sends more than 64 KiB in a frame"));
}

TEST_F(ServerLimitsTest, FramesOfAClient) {
  Serve({});
  WebClient client(port());
  try {
    // The limit is 200 frames a second. The test assumes that the machine sends more than this.
    for (int i = 0; i < 100'000; ++i) client.Send("x");
  } catch (const test::WebClosed&) {
  }
  EXPECT_TRUE(Waits(&ServerCounts::cut_off, 1));
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("cut off: sends more than 200 frames a second"));
}

TEST_F(ServerLimitsTest, PingsOfAClient) {
  Serve({});
  tcp::socket client = Open();
  std::string pings;
  for (int i = 0; i < 1000; ++i) pings += std::string("\x89\x80\1\2\3\4", 6);
  boost::asio::write(client, boost::asio::buffer(pings));
  EXPECT_TRUE(Waits(&ServerCounts::cut_off, 1));
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("cut off: sends more than 200 frames a second"));
}

TEST_F(ServerLimitsTest, AClientGetsTheFramesThatWaitForItWhenTheServerEnds) {
  view_.end = [this] { server_->Stop(); };
  // When the server ends, a client has 0.3 s to take the waiting frames. On a busy machine this
  // may be too short. Then the test tries again.
  constexpr int kTries = 5;
  std::vector<std::string> got;
  std::uint16_t code = 0;
  for (int i = 0; i < kTries && code == 0; ++i) {
    Serve({});
    WebClient client(port());
    client.Send("end");
    got.clear();
    try {
      while (true) got.push_back(client.Receive().bytes);
    } catch (const test::WebClosed& closed) {
      code = closed.code();
    }
    End();
  }
  EXPECT_THAT(got, ::testing::ElementsAre("one", "two", "three"));
  EXPECT_EQ(code, 1001);
}

TEST_F(ServerLimitsTest, BytesThatAreNoFrame) {
  Serve({});
  tcp::socket client = Open();
  boost::asio::write(client, boost::asio::buffer(std::string("\x83\x80\1\2\3\4", 6)));
  EXPECT_TRUE(IsClosed(client));
  client.close();  // the server waits for this, for the time of a request at most
  EXPECT_TRUE(Waits(&ServerCounts::cut_off, 1));
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("cut off: breaks RFC 6455: "));
}

TEST_F(ServerLimitsTest, SubprotocolThatTheServerDoesNotKnow) {
  Serve({});
  EXPECT_THROW(WebClient(port(), {.protocol = "other"}), test::WebRefused);
  EXPECT_EQ(Counts().refused, 1);
  EXPECT_THAT(End(), HasSubstr("refused: asks for no subprotocol of this server"));
}

TEST_F(ServerLimitsTest, WrongFramesAreCounted) {
  Serve({});
  WebClient client(port());
  for (const std::int64_t count : {1, 2}) {
    client.Send("wrong");
    EXPECT_EQ(client.Receive().bytes, "wrong");
    EXPECT_EQ(Counts().wrong_frames, count);
  }
  EXPECT_THAT(End(), HasSubstr("sends a wrong frame (2 so far): as the test says"));
}

TEST_F(ServerLimitsTest, TimeWithoutAnAnswerToAPing) {
  Serve({.silence = kShort});
  WebClient deaf(port());  // answers a ping only in Receive()
  EXPECT_TRUE(Waits(&ServerCounts::cut_off, 1));
  EXPECT_EQ(Counts().viewers, 0);
  ExpectServes();
  EXPECT_THAT(End(), HasSubstr("cut off: does not answer a ping for 2 s"));
}

}  // namespace
}  // namespace fogline::web
