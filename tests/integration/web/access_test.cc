// The limits of the server of `fogline view`, tested with real clients.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/web/viewed.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// A server that shows a network on which no program sends.
class ViewAccessTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_NE(viewed_.port(), 0) << viewed_.process().Err(); }

  std::uint16_t port() const { return viewed_.port(); }
  Background& process() { return viewed_.process(); }

  /// The status with which the server refuses a WebSocket; 101 if the server opens it.
  int StatusOfSocket(const WebClient::Options& options) const {
    try {
      WebClient client(port(), options);
      ReceiveOp(client, "hello");
      return 101;
    } catch (const WebRefused& refused) {
      return refused.status();
    }
  }
  std::string Host(const std::string& name = "127.0.0.1") const {
    return name + ":" + std::to_string(port());
  }
  /// Expects that the server still serves clients.
  void ExpectServes() const { EXPECT_EQ(StatusOfSocket({}), 101); }

  Viewed viewed_{{"--lcm-url", runtime::FreshMulticastUrl()}};
};

TEST_F(ViewAccessTest, PrintsTheAddressOfThisMachine) {
  EXPECT_EQ(viewed_.address(), "http://" + Host() + "/");
}

TEST_F(ViewAccessTest, RefusesForeignHostsAndOrigins) {
  EXPECT_EQ(StatusOfSocket({.origin = "http://" + Host()}), 101);
  EXPECT_EQ(StatusOfSocket({.host = Host("localhost")}), 101);
  EXPECT_EQ(StatusOfSocket({.host = "evil.example"}), 403);
  EXPECT_EQ(StatusOfSocket({.host = Host("evil.example")}), 403);
  EXPECT_EQ(StatusOfSocket({.origin = "http://evil.example"}), 403);
  EXPECT_EQ(StatusOfSocket({.origin = "null"}), 403);
  const std::string page = Exchange(port(), "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  EXPECT_EQ(StatusOf(page), 403);
  EXPECT_EQ(StatusOf(Exchange(port(), "GET / HTTP/1.1\r\n\r\n")), 403);
  EXPECT_TRUE(process().WaitForErr("refused: its Host header"));
  EXPECT_TRUE(process().WaitForErr("refused: a page of another origin asks"));
  ExpectServes();
}

TEST_F(ViewAccessTest, SpeaksItsOwnAndFoxglovesSubprotocols) {
  const auto chosen = [&](const std::string& asked) {
    return WebClient(port(), {.protocol = asked}).protocol();
  };
  EXPECT_EQ(chosen("fogline.view.v1"), "fogline.view.v1");
  EXPECT_EQ(chosen("unknown, fogline.view.v1"), "fogline.view.v1");
  EXPECT_EQ(chosen("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(chosen("foxglove.sdk.v1, foxglove.websocket.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(chosen(""), "");
  EXPECT_EQ(StatusOfSocket({.protocol = "unknown.v1"}), 400);
}

TEST_F(ViewAccessTest, KnowsOnlyGetAndItsOwnPaths) {
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/nothing"))), 404);
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/../../etc/passwd"))), 404);
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/ws"))), 426);
  const std::string host = "Host: " + Host() + "\r\n";
  const std::string head = Exchange(port(), "HEAD / HTTP/1.1\r\n" + host + "\r\n");
  EXPECT_EQ(StatusOf(head), 405);
  EXPECT_TRUE(head.ends_with("\r\n\r\n")) << head;  // without a body
  EXPECT_THAT(head, HasSubstr("Allow: GET"));
  const std::string body(100'000, 'x');
  EXPECT_EQ(StatusOf(Exchange(
                port(), "POST / HTTP/1.1\r\n" + host + "Content-Length: 100000\r\n\r\n" + body)),
            405);
  EXPECT_EQ(StatusOfSocket({.target = "/other"}), 404);
  ExpectServes();
}

TEST_F(ViewAccessTest, LetsAPageLoadOnlyItsOwnFiles) {
  const std::string answer = Exchange(port(), GetRequest(port(), "/nothing"));
  EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self'"));
  EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(answer, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(answer, Not(HasSubstr("unsafe")));
}

TEST_F(ViewAccessTest, RefusesWhatIsNoHttpOrTooLong) {
  EXPECT_EQ(StatusOf(Exchange(port(), "\x16\x03\x01 hello over TLS\r\n\r\n")), 400);
  const std::string line = "X-Long: " + std::string(1000, 'x') + "\r\n";
  std::string lines;
  for (int i = 0; i < 9; ++i) lines += line;
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/", lines))), 431);
  ExpectServes();
}

TEST_F(ViewAccessTest, ClosesAClientThatSendsALargeFrame) {
  WebClient client(port());
  client.Send(std::string(64 << 10, 'x'));
  EXPECT_EQ(ReceiveOp(client, "error")["id"], nullptr);
  client.Send(std::string((64 << 10) + 1, 'x'));
  EXPECT_EQ(CloseCodeOf(client), 1009);
  EXPECT_TRUE(process().WaitForErr("cut off: sends more than 64 KiB in a frame"));
  ExpectServes();
}

TEST_F(ViewAccessTest, ClosesAClientThatSendsTooManyFrames) {
  WebClient client(port());
  std::uint16_t code = 0;
  try {
    // If the machine sends fewer than 200 frames per second, the server never cuts this client off.
    // So the loop has a limit.
    for (int i = 0; i < 100'000; ++i) client.Send("{}");
  } catch (const WebClosed& closed) {
    code = closed.code();
  }
  if (code == 0) code = CloseCodeOf(client);
  EXPECT_TRUE(process().WaitForErr("cut off: sends more than 200 frames a second"));
  // The client gets no closing frame if its own frames are still in transit.
  EXPECT_TRUE(code == 1008 || code == 0) << code;
  ExpectServes();
}

TEST_F(ViewAccessTest, TurnsAway65thClient) {
  std::vector<WebClient> clients;
  for (int i = 0; i < 64; ++i) {
    clients.emplace_back(port());
    ReceiveOp(clients.back(), "hello");
  }
  EXPECT_EQ(StatusOfSocket({}), 503);
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/"))), 503);
  EXPECT_TRUE(process().WaitForErr("64 viewers are connected already"));
  clients.pop_back();
  // The server accepts another client only after it has noticed that the last client is gone. So
  // the test tries again and again.
  const TimePoint end = Clock::now() + milliseconds(20'000);
  int status = 503;
  while (status != 101 && Clock::now() < end) status = StatusOfSocket({});
  EXPECT_EQ(status, 101);
}

TEST_F(ViewAccessTest, EndsAtOnceWithCtrlC) {
  std::vector<WebClient> clients;
  for (int i = 0; i < 20; ++i) {
    clients.emplace_back(port());
    ReceiveOp(clients.back(), "hello");
  }
  const TimePoint began = Clock::now();
  process().Signal(SIGINT);
  EXPECT_EQ(CloseCodeOf(clients.front()), 1001);
  // The other clients do not answer the closing frame. The program must not wait for their answers.
  // If it waited, it would end only after its time limit of 10 s.
  EXPECT_EQ(process().Wait(), 0);
  EXPECT_LT(Clock::now() - began, milliseconds(9000));
}

TEST_F(ViewAccessTest, SaysThatAPortIsBusy) {
  const Outcome second =
      RunCommand({Program("fogline"), "view", "--no-browser", "--port", std::to_string(port()),
                  "--lcm-url", runtime::FreshMulticastUrl()});
  EXPECT_EQ(second.code, 2);
  EXPECT_EQ(second.err, "fogline view: error: --port: cannot listen on " + Host() +
                            ": Address already in use\n");
  EXPECT_EQ(second.out, "");
}

TEST(ViewTokenTest, ListensOnlyOnAnAddressOfThisMachine) {
  // RFC 5737 reserves 203.0.113.0/24 for examples, so no machine has an address of it.
  const Outcome outcome = RunCommand({Program("fogline"), "view", "--no-browser", "--listen",
                                      "203.0.113.7", "--lcm-url", "udpm://cannot.be.opened"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("error: --listen: 203.0.113.7 is no address of this machine"));
  EXPECT_EQ(outcome.out, "");
}

TEST(ViewTokenTest, NeedsTheTokenWhenItListensForOthers) {
  Viewed viewed({"--lcm-url", runtime::FreshMulticastUrl()}, {"--listen", "127.0.0.1:0"});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  const std::size_t hash = viewed.address().find("#token=");
  ASSERT_NE(hash, std::string::npos) << viewed.address();
  const std::string token = viewed.address().substr(hash + 7);
  EXPECT_EQ(token.size(), 32U);
  const auto status = [&](const std::string& target) {
    try {
      WebClient client(viewed.port(), {.target = target});
      return 101;
    } catch (const WebRefused& refused) {
      return refused.status();
    }
  };
  EXPECT_EQ(status("/ws?token=" + token), 101);
  EXPECT_EQ(status("/ws"), 403);
  EXPECT_EQ(status("/ws?token=" + std::string(32, '0')), 403);
  EXPECT_EQ(status("/ws?token=" + token + "0"), 403);
  EXPECT_NE(StatusOf(Exchange(viewed.port(), GetRequest(viewed.port(), "/"))), 403);
  EXPECT_TRUE(viewed.process().WaitForErr("refused: the token is missing or wrong"));
  // The token is a secret: only stdout has it.
  EXPECT_THAT(viewed.process().Err(), Not(HasSubstr(token)));
}

TEST(ViewTokenTest, LetsAViewerWithTheTokenInBesidesIdleConnections) {
  Viewed viewed({"--lcm-url", runtime::FreshMulticastUrl()}, {"--listen", "127.0.0.1:0"});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  const std::string token = viewed.address().substr(viewed.address().find("#token=") + 7);
  boost::asio::io_context context;
  std::vector<boost::asio::ip::tcp::socket> idle;
  for (int i = 0; i < 200; ++i) {
    idle.emplace_back(context).connect({boost::asio::ip::address_v4::loopback(), viewed.port()});
  }
  WebClient viewer(viewed.port(), {.target = "/ws?token=" + token});
  EXPECT_EQ(ReceiveOp(viewer, "hello")["mode"], "live");
  // To accept 200 more connections, the server closes older idle connections. The viewer must stay
  // connected.
  for (int i = 0; i < 200; ++i) {
    idle.emplace_back(context).connect({boost::asio::ip::address_v4::loopback(), viewed.port()});
  }
  const json health = ReceiveOp(viewer, "health");
  EXPECT_EQ(health["viewers"], 1);
  EXPECT_EQ(health["cut_off"], 0);
  EXPECT_TRUE(viewed.process().WaitForErr("refused: opens no view, and others want its place"));
}

TEST(ViewOptionsTest, RefusesContradictions) {
  const auto refusal = [](std::vector<std::string> more) {
    more.insert(more.begin(), {Program("fogline"), "view", "--no-browser"});
    const Outcome outcome = RunCommand(more);
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    return outcome.err;
  };
  EXPECT_THAT(refusal({"--open-at", "5"}), HasSubstr("LOG is missing"));
  EXPECT_THAT(refusal({"a.lcm", "--lcm-url", "udpm://239.255.76.67:7667"}), HasSubstr("--lcm-url"));
  EXPECT_THAT(refusal({"a.lcm", "--key", "key"}), HasSubstr("--key"));
  EXPECT_THAT(RunCommand({"env", "FOGLINE_KEY=key", Program("fogline"), "view", "no.lcm"}).err,
              HasSubstr("no.lcm"))
      << "a log needs no key";
  EXPECT_THAT(refusal({"--allow-origin", "*"}), HasSubstr("this is not an origin such as"));
  EXPECT_THAT(refusal({"--listen", "127.0.0.1", "--port", "1"}), HasSubstr("--port"));
  EXPECT_THAT(refusal({"--listen", "no.such.host.invalid"}), HasSubstr("--listen"));
  EXPECT_THAT(refusal({"--lcm-url", "memq://"}), HasSubstr("memory of a process"));
}

}  // namespace
}  // namespace fogline::test
