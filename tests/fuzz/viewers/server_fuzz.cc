// The server of `fogline view`, behind a real socket. Input: a byte, then what a client sends. The
// byte says how the client begins: with these bytes (0), or with a request that opens a WebSocket
// of a viewer (1), of the person who drives (2), or of Foxglove (3). In the bytes, "127.0.0.1:0"
// stands for the address of the server.
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "tests/fuzz/fuzz.h"
#include "tools/web/seat/seat_frame.h"
#include "tools/web/server/server.h"
#include "tools/web/view_messages.h"
#include "tools/web/view_request.h"

namespace fogline::fuzz {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::string_view kAddressInInput = "127.0.0.1:0";
constexpr std::array<std::string_view, 4> kProtocols{"", web::kViewProtocol, web::kDriveProtocol,
                                                     web::kFoxgloveProtocol};
constexpr std::array kStatuses{"101", "200", "304", "400", "403",
                               "404", "405", "426", "431", "503"};
// Far longer than the server needs, even on a busy machine.
constexpr std::chrono::seconds kPatience(20);

/// Takes the frames that the server passes on, as the views do.
class Frames final : public web::View {
 public:
  void Opened(web::Client&) override { ++open_; }
  void Received(web::Client& client, std::string_view bytes, bool binary) override {
    const bool drives = client.protocol() == web::kDriveProtocol;
    Demand(
        bytes.size() <= (drives ? web::Server::kMostSeatFrameBytes : web::Server::kMostFrameBytes),
        "no frame is larger than its limit");
    Took();
    if (web::IsFoxglove(client.protocol())) return;
    if (drives) {
      if (const auto frame = web::ParseSeatFrame(bytes);
          const auto* bad = std::get_if<web::BadSeatFrame>(&frame)) {
        Refuse(client, std::nullopt, bad->why);
      }
    } else if (const auto request = web::ParseViewFrame(bytes, binary);
               const auto* bad = std::get_if<web::BadRequest>(&request)) {
      Refuse(client, bad->id, bad->why);
    }
  }
  void Idle(web::Client&) override {}
  void Closed(web::Client&) override { --open_; }

  int open() const { return open_; }
  std::int64_t wrong() const { return wrong_; }

 private:
  void Refuse(web::Client& client, std::optional<web::RequestId> id, const std::string& why) {
    ++wrong_;
    client.CountWrongFrame(why);
    client.Send(web::TextFrame(web::ErrorText(id, why)));
  }

  int open_ = 0;
  std::int64_t wrong_ = 0;
};

/// One server for all inputs. It runs until the program ends. If the server kept data of a client,
/// these data could change the result of a later input. So AnswerTo() waits until the server has
/// removed the client.
class Served {
 public:
  std::string host() const { return fmt::format("127.0.0.1:{}", server_.access().rules().port); }

  /// Sends the bytes as a client, and then closes the sending direction. @return the answer
  /// @param opening a request that opens a WebSocket, or ""; the client sends it first, and waits
  /// for the answer to it
  std::string AnswerTo(std::string_view opening, std::string_view bytes) {
    tcp::socket client = Connected();
    client.non_blocking(true);
    // The kernel accepts these few bytes completely in one call.
    if (!opening.empty()) client.write_some(asio::buffer(opening));
    const auto end = std::chrono::steady_clock::now() + kPatience;
    std::string answer;
    error_code ended;
    while (!ended) {
      Demand(std::chrono::steady_clock::now() < end, "the server ends each connection");
      if (context_.poll() == 0) context_.run_one_for(std::chrono::milliseconds(1));
      const bool answered = answer.find("\r\n\r\n") != std::string::npos;
      if (opening.empty() || answered) Write(client, bytes);
      ended = Read(client, answer);
    }
    client.close();
    while (view_.open() > 0 || server_.counts().viewers > 0) {
      Demand(std::chrono::steady_clock::now() < end, "a client that has gone takes no place");
      context_.run_one_for(std::chrono::milliseconds(1));
    }
    Demand(view_.open() == 0 && server_.counts().drivers == 0, "each client comes and goes once");
    Demand(server_.counts().wrong_frames == view_.wrong(), "each wrong frame is counted once");
    return answer;
  }

 private:
  /// A connected client. A signal of the fuzzer's timer may interrupt the attempt to connect; then
  /// the attempt is repeated.
  tcp::socket Connected() {
    const tcp::endpoint place(asio::ip::address_v4::loopback(), server_.access().rules().port);
    for (;;) {
      tcp::socket client(context_);
      error_code error;
      client.connect(place, error);
      if (!error) return client;
      Demand(error == asio::error::interrupted, "the server accepts each client");
    }
  }

  /// Sends as many bytes as the kernel accepts. Closes the sending direction after the last byte,
  /// or after an error.
  static void Write(tcp::socket& client, std::string_view& bytes) {
    if (bytes.data() == nullptr) return;
    error_code error;
    bytes.remove_prefix(client.write_some(asio::buffer(bytes), error));
    if (error == asio::error::would_block) return;
    if (!error && !bytes.empty()) return;
    client.shutdown(tcp::socket::shutdown_send, error);
    bytes = {};
  }

  /// Appends the received bytes to `answer`. @return success as long as more bytes may come
  static error_code Read(tcp::socket& client, std::string& answer) {
    std::array<char, 4096> buffer;
    error_code error;
    const std::size_t size = client.read_some(asio::buffer(buffer), error);
    answer.append(buffer.data(), size);
    return error == asio::error::would_block ? error_code() : error;
  }

  static constexpr std::array kFiles{web::Asset{
      .path = "/index.html", .type = "text/html", .etag = "\"1\"", .bytes = "<!DOCTYPE html>"}};

  asio::io_context context_{1};
  Frames view_;
  web::Server server_{context_, {.origins = {}, .limits = {}, .seat = true}, kFiles, view_};
};

void DemandHttp(std::string_view answer) {
  if (answer.empty()) return;  // the client has sent nothing that needs an answer
  Demand(answer.starts_with("HTTP/1.1 "), "an answer is HTTP");
  const std::string_view status = answer.substr(9, 3);
  bool known = false;
  for (const std::string_view one : kStatuses) known = known || status == one;
  Demand(known, "an answer has one of the known statuses");
  Demand(answer.find("\r\nContent-Security-Policy: default-src 'none'") != std::string_view::npos,
         "each answer has the headers that protect the page");
  if (status == "200") Took();
}

std::string WithAddress(std::string text, const std::string& host) {
  const std::size_t place = text.find(kAddressInInput);
  return place == std::string::npos ? text : text.replace(place, kAddressInInput.size(), host);
}

std::string OpeningRequest(const std::string& host, std::string_view protocol) {
  return fmt::format(
      "GET /ws HTTP/1.1\r\nHost: {}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Protocol: {}\r\n\r\n",
      host, protocol);
}

/// A frame of a WebSocket (RFC 6455, 5.2). @param head FIN and opcode
std::string MaskedFrame(char head, std::string_view text) {
  std::string frame{head, static_cast<char>(0x80U | text.size()), 1, 2, 3, 4};
  for (std::size_t i = 0; i < text.size(); ++i) frame += static_cast<char>(text[i] ^ (i % 4 + 1));
  return frame;
}

}  // namespace

std::vector<Input> Seeds() {
  constexpr char kText = '\x81';
  constexpr char kBegins = '\x01';
  constexpr char kContinues = '\x80';
  constexpr char kCloses = '\x88';
  constexpr char kPing = '\x89';
  const std::string request = R"({"op":"history","id":1})";
  const std::string head = "GET / HTTP/1.1\r\nHost: 127.0.0.1:0\r\n";
  std::vector<Input> seeds;
  for (const auto& [how, bytes] : std::initializer_list<std::pair<std::uint8_t, std::string>>{
           {0, head + "\r\n"},
           {0, head + "Origin: http://127.0.0.1:0\r\nIf-None-Match: \"1\"\r\n\r\n"},
           {0, "GET /../etc/passwd?a=b HTTP/1.0\r\nHost: evil.example\r\n\r\n"},
           {0, "POST /drive HTTP/1.1\r\nHost: 127.0.0.1:0\r\nContent-Length: 3\r\n\r\nabc"},
           {0,
            "GET / HTTP/1.1\r\nHost: 127.0.0.1:0\r\nTransfer-Encoding: "
            "chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n"},
           {0, OpeningRequest(std::string(kAddressInInput), "other")},
           {1, MaskedFrame(kText, request) + MaskedFrame(kPing, "ping") + MaskedFrame(kCloses, "")},
           {1, MaskedFrame(kBegins, "{\"op\":") + MaskedFrame(kContinues, "\"steps\"}")},
           {1, std::string("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff\1\2\3\4", 14)},
           {2, MaskedFrame(kText, R"({"op":"input","sequence":1,"age_ms":3,"present":true})")},
           {3, MaskedFrame(kText, R"({"op":"subscribe","subscriptions":[]})")}}) {
    Input& seed = seeds.emplace_back(Input{how});
    seed.insert(seed.end(), bytes.begin(), bytes.end());
  }
  return seeds;
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogline::fuzz;
  if (size == 0) return 0;
  static Served served;
  const std::string_view protocol = kProtocols[data[0] % kProtocols.size()];
  const std::string opening = protocol.empty() ? "" : OpeningRequest(served.host(), protocol);
  const std::string bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  DemandHttp(served.AnswerTo(opening, WithAddress(bytes, served.host())));
  return 0;
}
