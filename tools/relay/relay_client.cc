#include "tools/relay/relay_client.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/core.h>
#include <boost/asio/buffer.hpp>

#include "common/file.h"
#include "tools/relay/relay.h"

namespace fogline::relay {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

// A client has to send its magic (the first bytes of the tcpq protocol) within this time after it
// connects.
constexpr std::chrono::seconds kGreetingLimit(5);
// The messages to a client wait in a queue. If messages of the client itself have filled half of
// the queue, the relay stops reading from the client. It reads again when the queue has room, or
// when the client has accepted nothing for this time. The time is our choice: even on a busy
// machine, a process waits less than this time for a processor.
constexpr std::chrono::seconds kLongestPause(5);

std::string AddressOf(const boost::asio::ip::tcp::socket& socket) {
  error_code error;
  const auto peer = socket.remote_endpoint(error);
  if (error) return "a client that has left already";
  return fmt::format("{}:{}", peer.address().to_string(), peer.port());
}

/// Acknowledges received data immediately. LCM's client sends a message in five pieces, and waits
/// for the acknowledgement of the first piece before it sends the second piece. The kernel delays
/// an acknowledgement by up to 40 ms, unless TCP_QUICKACK is set again after each read.
void AcknowledgeAtOnce(boost::asio::ip::tcp::socket& socket) {
  const int on = 1;
  setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_QUICKACK, &on, sizeof(on));
}

}  // namespace

RelayClient::RelayClient(Relay& relay, std::uint64_t id, tcp::socket socket)
    : relay_(relay),
      id_(id),
      socket_(std::move(socket)),
      address_(AddressOf(socket_)),
      greeting_(socket_.get_executor()),
      pause_(socket_.get_executor()),
      parser_(runtime::tcpq::kClientMagic, relay.options_.limits),
      subscriptions_(relay.options_.subscriptions),
      read_(kWorthACall) {}

void RelayClient::Start() {
  error_code ignored;  // if the socket is closed, the next read reports this
  socket_.set_option(tcp::no_delay(true), ignored);
  socket_.set_option(asio::socket_base::keep_alive(true), ignored);
  greeting_.expires_after(kGreetingLimit);
  greeting_.async_wait([self = shared_from_this()](error_code error) {
    if (!error && !self->greeted_) {
      self->Drop(fmt::format("has not said in {} s that it is a client", kGreetingLimit.count()));
    }
  });
  runtime::tcpq::AppendHello(runtime::tcpq::kRelayMagic, waiting_);
  Write();
  Read();
}

void RelayClient::Offer(const runtime::tcpq::Frame& message) {
  if (gone_ || deaf_ || !Wants(message.name)) return;
  const std::size_t queued = Queued();
  if (queued > 0 && queued + message.wire.size() > relay_.options_.queue_bytes) {
    return Drop(fmt::format("does not read; {} bytes wait for it", queued));
  }
  waiting_.insert(waiting_.end(), message.wire.begin(), message.wire.end());
  relay_.Sent(message.payload.size());
  Write();
}

bool RelayClient::Wants(std::string_view channel) {
  try {
    return subscriptions_.Match(channel, Clock::now());
  } catch (const std::exception&) {
    Drop("its subscriptions take too long to match");
    return false;
  }
}

void RelayClient::Drop(const std::string& why) {
  if (std::exchange(gone_, true)) return;
  greeting_.cancel();
  pause_.cancel();
  error_code ignored;
  socket_.close(ignored);
  relay_.Leave(id_, address_, why);
}

void RelayClient::Read() {
  socket_.async_read_some(asio::buffer(read_),
                          [self = shared_from_this()](error_code error, std::size_t size) {
                            if (self->gone_) return;
                            if (error) return self->Drop("");
                            const std::size_t before = self->Queued();
                            self->Take(runtime::Bytes(self->read_).first(size));
                            if (self->gone_) return;
                            AcknowledgeAtOnce(self->socket_);
                            // Since `before`, only messages of this client have been handled. So
                            // only they can have made its queue longer.
                            const bool fills_itself = self->Queued() > before && self->LacksRoom();
                            fills_itself && !self->stuck_ ? self->Pause() : self->Read();
                          });
}

bool RelayClient::LacksRoom() const {
  const std::size_t most = relay_.options_.queue_bytes;
  const std::size_t message = std::min(most, relay_.options_.limits.payload);
  return Queued() + std::max(most / 2, message) > most;
}

void RelayClient::Pause() {
  paused_ = true;
  pause_.expires_after(kLongestPause);
  pause_.async_wait([self = shared_from_this()](error_code cancelled) {
    // If this handler already waits to be called when its timer is cancelled or set again, it gets
    // no error. So it checks the time and the state, too.
    const bool over = self->pause_.expiry() <= boost::asio::steady_timer::clock_type::now();
    if (cancelled || !over || !self->paused_ || self->gone_) return;
    self->stuck_ = true;
    self->EndPause();
  });
}

void RelayClient::EndPause() {
  paused_ = false;
  pause_.cancel();
  Read();
}

void RelayClient::Progress() {
  stuck_ = false;
  if (!paused_ || gone_) return;
  LacksRoom() ? Pause() : EndPause();
}

void RelayClient::Take(runtime::Bytes bytes) {
  parser_.Append(bytes);
  while (!gone_) {
    const auto frame = parser_.Next();
    if (!greeted_ && parser_.Greeted()) {
      greeted_ = true;
      greeting_.cancel();
      relay_.Greeted();
    }
    if (!parser_.error().empty()) return Drop(parser_.error());
    if (!frame) return;
    Handle(*frame);
  }
}

void RelayClient::Handle(const runtime::tcpq::Frame& frame) {
  switch (frame.type) {
    case runtime::tcpq::FrameType::kPublish:
      return relay_.Forward(frame);
    case runtime::tcpq::FrameType::kSubscribe:
      if (const std::string wrong = subscriptions_.Add(frame.name); !wrong.empty()) Drop(wrong);
      return;
    case runtime::tcpq::FrameType::kUnsubscribe:
      return subscriptions_.Remove(frame.name);
  }
}

void RelayClient::Write() {
  if (!sending_.empty() || waiting_.empty() || gone_) return;
  std::swap(sending_, waiting_);
  WriteRest();
}

void RelayClient::WriteRest() {
  socket_.async_write_some(asio::buffer(sending_) + sent_,
                           [self = shared_from_this()](error_code error, std::size_t size) {
                             self->sent_ += size;
                             if (error) {
                               self->deaf_ = true;
                               self->waiting_.clear();
                             }
                             const bool rest = !error && self->sent_ < self->sending_.size();
                             if (!rest) {
                               self->sending_.clear();
                               self->sent_ = 0;
                               // If the queue was long, its memory is freed.
                               if (self->sending_.capacity() > kWorthACall) {
                                 self->sending_.shrink_to_fit();
                               }
                             }
                             self->Progress();
                             rest ? self->WriteRest() : self->Write();
                           });
}

}  // namespace fogline::relay
