#include "tools/web/server/connection.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "common/clock.h"
#include "tools/web/server/frame_budget.h"
#include "tools/web/server/http_answer.h"
#include "tools/web/server/subprotocol.h"

namespace fogline::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using tcp = asio::ip::tcp;

// Time in which a client that is cut off may read the reason.
constexpr std::chrono::seconds kCutOffLimit(1);
constexpr unsigned kBadRequest = 400;
constexpr unsigned kHeaderTooLarge = 431;
constexpr unsigned kUnavailable = 503;
// If more bytes than this wait to be sent to a client, no frame of this client is read.
constexpr std::size_t kPauseBytes = 1 << 20;
// Bytes for a client that the kernel may keep, in addition to the bytes in the queue.
constexpr int kKernelBytes = 256 << 10;

std::string AddressOf(const tcp::socket& socket) {
  error_code error;
  const auto peer = socket.remote_endpoint(error);
  if (error) return "a client that has left already";
  return fmt::format("{}:{}", peer.address().to_string(), peer.port());
}

std::string_view TextOf(beast::string_view text) { return {text.data(), text.size()}; }

/// Whether a client has broken the WebSocket protocol in another way than by a large frame.
bool IsWrong(error_code error) {
  const error_code any = websocket::error::closed;
  return error.category() == any.category() && error != websocket::error::closed &&
         error != websocket::error::message_too_big;
}

using Request = http::request<http::empty_body>;
using Response = http::response<http::span_body<const char>>;

void SetSafetyHeaders(http::fields& headers) {
  for (const auto& [name, value] : SafetyHeaders()) {
    headers.set(beast::string_view(name.data(), name.size()),
                beast::string_view(value.data(), value.size()));
  }
}

RequestOrigin OriginOf(const Request& request, std::string_view protocol) {
  return {.host = TextOf(request[http::field::host]),
          .origin = TextOf(request[http::field::origin]),
          .target = TextOf(request.target()),
          .drives = protocol == kDriveProtocol};
}

}  // namespace

class BeastConnection final : public Connection,
                              public std::enable_shared_from_this<BeastConnection> {
 public:
  BeastConnection(Server& server, std::uint64_t id, tcp::socket socket)
      : Connection(server, id),
        address_(AddressOf(socket)),
        stream_(std::move(socket)),
        farewell_(context()) {}

  void Begin();

  void GoAway() override;
  void GiveWay() override;
  const std::string& address() const override { return address_; }
  std::string_view protocol() const override { return protocol_; }
  std::size_t waiting() const override { return queue_.bytes(); }
  void Send(OutgoingFrame frame) override;
  void CutOff(CloseCode code, const std::string& why) override;

 private:
  using Socket = websocket::stream<beast::tcp_stream>;

  std::size_t MostFrameBytes() const {
    return drives() ? Server::kMostSeatFrameBytes : Server::kMostFrameBytes;
  }
  void Handle(error_code error);
  void HandleError(error_code error);
  void HandleRequest();
  void Refuse(unsigned status, std::string_view why, std::string text);
  void Write(HttpAnswer answer);
  void Linger();
  void Upgrade();
  void Open();
  void Read();
  void CutOffFlood();
  void TakeFrame();
  void WriteNext();
  void Close(CloseCode code, const std::string& why, std::chrono::milliseconds limit);
  void SendClose();
  void Leave();

  const std::string address_;
  beast::tcp_stream stream_;  // until the WebSocket is opened
  beast::flat_buffer buffer_{Server::kMostFrameBytes + Server::kMostHeaderBytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  HttpAnswer answer_;  // `text` must exist until the answer has been sent
  std::optional<Response> response_;

  std::optional<Socket> socket_;
  std::string_view protocol_ = kViewProtocol;
  SendQueue queue_;
  std::optional<FrameBudget> budget_;
  asio::steady_timer farewell_;  // runs while the connection is being closed
  std::optional<websocket::close_reason> reason_;
  bool opened_ = false;   // whether the view knows this client
  bool reading_ = false;  // whether a read operation waits for a frame
  bool writing_ = false;  // whether the front of the queue is being sent
  bool gone_ = false;
};

// ---- HTTP --------------------------------------------------------------------------------------

void BeastConnection::Begin() {
  error_code ignored;  // the next operation reports a closed socket
  stream_.socket().set_option(tcp::no_delay(true), ignored);
  stream_.socket().set_option(asio::socket_base::send_buffer_size(kKernelBytes), ignored);
  parser_.emplace();
  parser_->header_limit(Server::kMostHeaderBytes);
  stream_.expires_after(limits().request);
  http::async_read_header(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](error_code error, std::size_t) { self->Handle(error); });
}

void BeastConnection::Handle(error_code error) {
  if (gone_) return;
  if (error) return HandleError(error);
  HandleRequest();
}

void BeastConnection::HandleError(error_code error) {
  if (error == beast::error::timeout) {
    CountRefused(fmt::format("sends no request within {} s", Seconds(limits().request)));
    return Leave();
  }
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return Refuse(kHeaderTooLarge,
                  fmt::format("sends more than {} KiB of headers", Server::kMostHeaderBytes >> 10),
                  "The headers are too large.\n");
  }
  if (error.category() == http::make_error_code(http::error::bad_method).category() &&
      error != http::error::end_of_stream && error != http::error::partial_message) {
    return Refuse(kBadRequest, "sends no request of HTTP", "This is no request of HTTP.\n");
  }
  Leave();
}

void BeastConnection::HandleRequest() {
  const Request& request = parser_->get();
  const bool seat = access().rules().seat;
  protocol_ = ChooseProtocol(TextOf(request[http::field::sec_websocket_protocol]), seat);
  const RequestOrigin from = OriginOf(request, protocol_);
  const bool opens = websocket::is_upgrade(request) && PathOf(from.target) == kSocketPath &&
                     access().OfWebSocket(from) == Verdict::kAllowed;
  if (opens) {
    constexpr std::string_view kWhy = "asks for no subprotocol of this server";
    if (protocol_.empty()) return Refuse(kBadRequest, kWhy, SubprotocolsText(seat));
    if (TakePlace()) return Upgrade();
  }
  // If all places of viewers are taken, the page for viewers is refused, too: without a WebSocket
  // it would show nothing.
  const bool may_drive = seat && !opens && MayBeOfDrivePage(PathOf(from.target));
  if (IsFull() && !may_drive && access().OfPage(from) == Verdict::kAllowed) {
    return Refuse(kUnavailable, fmt::format("{} viewers are connected already", limits().viewers),
                  "Too many viewers are connected. Try again later.\n");
  }
  Write(Answer({.method = TextOf(request.method_string()),
                .from = from,
                .if_none_match = TextOf(request[http::field::if_none_match])},
               access(), assets()));
}

/// Answers with a line of text. @param why reason for stderr
void BeastConnection::Refuse(unsigned status, std::string_view why, std::string text) {
  CountRefused(why);
  Write(Refusal(status, std::move(text)));
}

void BeastConnection::Write(HttpAnswer answer) {
  if (answer.verdict != Verdict::kAllowed) CountRefused(WhyRefused(answer.verdict));
  answer_ = std::move(answer);
  const std::string_view body = answer_.text.empty() ? answer_.body : answer_.text;
  response_.emplace(http::status(answer_.status), 11);
  SetSafetyHeaders(*response_);
  for (const auto& [name, value] : answer_.headers) {
    response_->set(beast::string_view(name.data(), name.size()), value);
  }
  // A connection handles one request. Otherwise the idle connections of browsers would use up the
  // limits for callers (server.h).
  response_->keep_alive(false);
  constexpr unsigned kNotModified = 304;  // this answer says nothing about the size of the file
  if (answer_.status != kNotModified) response_->content_length(body.size());
  const bool head = parser_->get().method() == http::verb::head;
  if (!head) response_->body() = {body.data(), body.size()};
  stream_.expires_after(limits().request);
  http::async_write(
      stream_, *response_, [self = shared_from_this()](error_code error, std::size_t) {
        if (error == beast::error::timeout) {
          self->CountRefused(
              fmt::format("does not take its answer within {} s", Seconds(self->limits().request)));
        }
        if (error || self->gone_) return self->Leave();
        self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
        self->stream_.expires_after(kCutOffLimit);
        self->Linger();
      });
}

// If a socket is closed while bytes of the client are unread, the client may lose the answer. So
// this function reads and drops the remaining bytes of the client.
void BeastConnection::Linger() {
  buffer_.clear();
  stream_.async_read_some(buffer_.prepare(Server::kMostFrameBytes),
                          [self = shared_from_this()](error_code error, std::size_t) {
                            if (error || self->gone_) return self->Leave();
                            self->Linger();
                          });
}

// ---- WebSocket ---------------------------------------------------------------------------------

void BeastConnection::Upgrade() {
  stream_.expires_never();  // the WebSocket has its own time limits
  socket_.emplace(std::move(stream_));
  socket_->set_option(websocket::stream_base::timeout{.handshake_timeout = limits().request,
                                                      .idle_timeout = limits().silence,
                                                      .keep_alive_pings = true});
  const bool named = !parser_->get()[http::field::sec_websocket_protocol].empty();
  socket_->set_option(websocket::stream_base::decorator(
      [named, protocol = protocol_](websocket::response_type& response) {
        SetSafetyHeaders(response);
        if (!named) return;
        response.set(http::field::sec_websocket_protocol,
                     beast::string_view(protocol.data(), protocol.size()));
      }));
  socket_->read_message_max(MostFrameBytes());
  socket_->auto_fragment(false);
  // Pings and pongs count as frames. The callback runs within a read operation, so it does not call
  // CutOffFlood() itself, but posts the call.
  socket_->control_callback([this](websocket::frame_type kind, beast::string_view) {
    if (kind == websocket::frame_type::close || !budget_ || budget_->Take(Clock::now())) return;
    asio::post(context(), [self = shared_from_this()] { self->CutOffFlood(); });
  });
  socket_->async_accept(parser_->get(), [self = shared_from_this()](error_code error) {
    if (error && IsWrong(error)) {
      self->CountRefused(fmt::format("opens no WebSocket: {}", error.message()));
    }
    if (error || self->gone_) return self->Leave();
    self->Open();
  });
}

void BeastConnection::Open() {
  parser_.reset();
  buffer_.clear();
  budget_.emplace(Clock::now(), drives() ? FrameBudget::kSeatFrames : FrameBudget::kFrames);
  opened_ = true;
  view().Opened(*this);
  Read();
}

void BeastConnection::Read() {
  if (gone_ || reading_ || queue_.bytes() > kPauseBytes) return;
  reading_ = true;
  socket_->async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    self->reading_ = false;
    if (self->gone_) return;
    if (error == websocket::error::message_too_big) {
      // Beast has sent the reason to the client.
      self->CountCutOff(
          fmt::format("sends more than {} KiB in a frame", self->MostFrameBytes() >> 10));
    }
    if (error == beast::error::timeout && !self->reason_) {
      self->CountCutOff(
          fmt::format("does not answer a ping for {} s", Seconds(self->limits().silence)));
    }
    if (IsWrong(error) && !self->reason_)
      self->CountCutOff(fmt::format("breaks RFC 6455: {}", error.message()));
    if (error) return self->Leave();
    self->TakeFrame();
  });
}

void BeastConnection::CutOffFlood() {
  CutOff(CloseCode::kPolicyViolation,
         fmt::format("sends more than {} frames a second", budget_->frames()));
}

void BeastConnection::TakeFrame() {
  if (!reason_ && !budget_->Take(Clock::now())) CutOffFlood();
  if (!reason_) {
    const auto bytes = buffer_.cdata();
    view().Received(*this, {static_cast<const char*>(bytes.data()), bytes.size()},
                    socket_->got_binary());
  }
  buffer_.clear();
  Read();  // also reads the last frame of a client that is being closed
}

void BeastConnection::Send(OutgoingFrame frame) {
  if (gone_ || reason_ || !socket_) return;
  const std::size_t waiting = queue_.bytes();
  if (!queue_.Push(std::move(frame))) {
    return CutOff(CloseCode::kTryAgainLater,
                  fmt::format("does not read; {} bytes wait for it", waiting));
  }
  WriteNext();
}

void BeastConnection::WriteNext() {
  if (gone_ || writing_ || queue_.empty()) return;
  writing_ = true;
  const OutgoingFrame& frame = queue_.front();
  socket_->binary(frame.binary);
  socket_->async_write(asio::buffer(*frame.bytes),
                       [self = shared_from_this()](error_code error, std::size_t) {
                         self->writing_ = false;
                         if (self->gone_) return;
                         if (error) return self->Leave();
                         self->queue_.Pop();
                         if (self->reason_ && self->queue_.empty()) return self->SendClose();
                         self->WriteNext();
                         if (self->reason_) return;
                         if (self->queue_.empty()) self->view().Idle(*self);
                         self->Read();
                       });
}

void BeastConnection::CutOff(CloseCode code, const std::string& why) {
  if (gone_ || reason_) return;
  CountCutOff(why);
  Close(code, why, kCutOffLimit);
}

void BeastConnection::GoAway() {
  if (gone_) return;
  if (!opened_) return Leave();
  if (!reason_) Close(CloseCode::kGoingAway, "the program ends", Server::kFarewell);
}

void BeastConnection::GiveWay() {
  if (gone_) return;
  CountRefused("opens no view, and others want its place");
  Leave();
}

void BeastConnection::Close(CloseCode code, const std::string& why,
                            std::chrono::milliseconds limit) {
  reason_.emplace(static_cast<websocket::close_code>(code), why.substr(0, 120));
  // A client that is cut off gets only the reason. When the program ends, a client also gets the
  // frames that wait for it. A slow client does not get these frames, because otherwise the reason
  // would come too late.
  if (code != CloseCode::kGoingAway || queue_.bytes() > kPauseBytes) queue_.Clear(writing_);
  farewell_.expires_after(limit);
  farewell_.async_wait([self = shared_from_this()](error_code stopped) {
    if (!stopped) self->Leave();
  });
  // A frame that is being sent must be complete before the closing frame.
  if (!writing_) SendClose();
}

void BeastConnection::SendClose() {
  socket_->async_close(*reason_, [self = shared_from_this()](error_code) { self->Leave(); });
}

void BeastConnection::Leave() {
  if (std::exchange(gone_, true)) return;
  farewell_.cancel();
  error_code ignored;
  auto& stream = socket_ ? beast::get_lowest_layer(*socket_) : stream_;
  stream.socket().close(ignored);
  stream.close();
  // The removal is postponed, because a view may be calling this client at the moment.
  asio::post(context(), [self = shared_from_this()] { self->LeaveServer(self->opened_); });
}

std::shared_ptr<Connection> Connection::Start(Server& server, std::uint64_t id,
                                              tcp::socket socket) {
  auto connection = std::make_shared<BeastConnection>(server, id, std::move(socket));
  connection->Begin();
  return connection;
}

}  // namespace fogline::web
