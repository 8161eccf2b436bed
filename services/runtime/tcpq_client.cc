#include "services/runtime/tcpq_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include <fmt/core.h>

#include "scenario/file.h"

namespace fogline::tcpq {
namespace {

// How long a relay may take to answer, and to take at least a byte of what it is sent.
constexpr Duration kAnswerLimit = milliseconds(5000);
constexpr Duration kStallLimit = milliseconds(5000);
constexpr std::size_t kReadBytes = 64 << 10;
// What is kept of what the relay sends while it takes nothing.
constexpr std::size_t kMaxReceived = 64 << 20;
// Who publishes so much without a look at what has come takes that look: a relay disconnects those
// that read nothing.
constexpr std::size_t kReadEvery = 256 << 10;

}  // namespace

Client::Client(const std::string& url, const Limits& limits)
    : endpoint_(ResolveUrl(url)),
      limits_(limits),
      parser_(kRelayMagic, limits),
      chunk_(kReadBytes) {
  try {
    Connect();
    Greet();
  } catch (...) {
    if (fd_ >= 0) close(fd_);
    throw;
  }
}

Client::~Client() {
  if (fd_ >= 0) close(fd_);
}

void Client::Connect() {
  fd_ = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd_ < 0) {
    ThrowIfExhausted(errno, endpoint_.ToString());
    throw std::runtime_error(fmt::format("no socket: {}", std::strerror(errno)));
  }
  const int on = 1;  // a message is a packet at once, not when the one before is acknowledged
  setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint_.port);
  inet_pton(AF_INET, endpoint_.address.c_str(), &address.sin_addr);
  int error = 0;
  if (connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    error = errno;
  }
  if (error == EINPROGRESS) {
    socklen_t size = sizeof(error);
    error = ETIMEDOUT;
    if (Ready(POLLOUT, kAnswerLimit)) getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size);
  }
  if (error == ECONNREFUSED) {
    throw std::runtime_error(
        fmt::format("nobody listens on {}; start fogline-relay there", endpoint_.ToString()));
  }
  if (error != 0) {
    throw std::runtime_error(
        fmt::format("cannot reach {}: {}", endpoint_.ToString(), std::strerror(error)));
  }
}

void Client::Greet() {
  AppendHello(kClientMagic, frame_);
  SendFrame();
  const TimePoint end = Clock::now() + kAnswerLimit;
  while (!parser_.Greeted()) {
    if (!Ready(POLLIN, end - Clock::now())) {
      if (Clock::now() < end) continue;  // a signal
      throw std::runtime_error(
          fmt::format("{} takes connections but does not answer: is it a fogline-relay?",
                      endpoint_.ToString()));
    }
    Receive();
    parser_.Append(received_);
    received_.clear();
    if (!parser_.Greeted() && !parser_.error().empty()) Lose(parser_.error());
  }
}

void Client::Subscribe(std::string_view channel, std::string_view pattern, Handler handler) {
  handlers_.emplace_back(channel, std::move(handler));
  frame_.clear();
  AppendFrame(FrameType::kSubscribe, pattern, {}, frame_);
  SendFrame();
}

void Client::SubscribeAll(Watcher watcher) {
  watcher_ = std::move(watcher);
  frame_.clear();
  AppendFrame(FrameType::kSubscribe, ".*", {}, frame_);
  SendFrame();
}

void Client::Publish(std::string_view channel, Bytes bytes) {
  if (channel.size() > limits_.channel || bytes.size() > limits_.payload) {
    throw std::runtime_error(
        fmt::format("{} bytes on \"{}\" are too many for tcpq", bytes.size(), channel));
  }
  frame_.clear();
  AppendFrame(FrameType::kPublish, channel, bytes, frame_);
  SendFrame();
}

void Client::SendFrame() {
  if (fd_ < 0) return;
  std::optional<TimePoint> stalled;
  for (std::size_t sent = 0; sent < frame_.size();) {
    const ssize_t size = send(fd_, frame_.data() + sent, frame_.size() - sent, MSG_NOSIGNAL);
    if (size > 0) {
      sent += static_cast<std::size_t>(size);
      stalled.reset();
      continue;
    }
    if (size < 0 && errno != EAGAIN && errno != EINTR) Lose(std::strerror(errno));
    const TimePoint now = Clock::now();
    if (!stalled) stalled = now;
    if (now - *stalled >= kStallLimit) {
      Lose(fmt::format("it has taken nothing for {} s", Milliseconds(kStallLimit) / 1000));
    }
    const bool room = received_.size() < kMaxReceived;
    if (Ready(room ? POLLOUT | POLLIN : POLLOUT, *stalled + kStallLimit - now) && room) Receive();
  }
  sent_unread_ += frame_.size();
  if (sent_unread_ < kReadEvery) return;
  sent_unread_ = 0;
  while (received_.size() < kMaxReceived && Ready(POLLIN, Duration::zero())) Receive();
}

bool Client::Readable(Duration timeout) {
  if (Parse()) return true;
  if (received_.empty()) {
    if (!Ready(POLLIN, timeout)) return false;
    Receive();
    sent_unread_ = 0;
  }
  parser_.Append(received_);
  received_.clear();
  return Parse();
}

bool Client::Parse() {
  if (!next_) next_ = parser_.Next();
  if (!parser_.error().empty() && fd_ >= 0) Lose("it " + parser_.error());
  return next_.has_value();
}

void Client::Handle() {
  if (!Parse()) return;
  const Frame frame = *next_;  // its bytes stay until Readable() appends others
  next_.reset();
  for (const auto& [channel, handler] : handlers_) {
    if (channel == frame.name) handler(frame.payload);
  }
  if (watcher_) watcher_(frame.name, frame.payload);
}

bool Client::Ready(short events, Duration timeout) const {
  pollfd waited{.fd = fd_, .events = events, .revents = 0};  // a lost one only waits
  const auto left = std::max(Duration::zero(), timeout);
  const timespec limit{.tv_sec = duration_cast<std::chrono::seconds>(left).count(),
                       .tv_nsec = static_cast<long>((left % std::chrono::seconds(1)).count())};
  return ppoll(&waited, 1, &limit, nullptr) > 0;
}

void Client::Receive() {
  const ssize_t size = recv(fd_, chunk_.data(), chunk_.size(), 0);
  if (size == 0) Lose("it has closed the connection");
  if (size < 0 && errno != EAGAIN && errno != EINTR) Lose(std::strerror(errno));
  if (size > 0) received_.insert(received_.end(), chunk_.begin(), chunk_.begin() + size);
}

void Client::Lose(std::string_view why) {
  close(fd_);
  fd_ = -1;
  throw ConnectionLost(fmt::format("lost the relay {}: {}", endpoint_.Url(), why));
}

}  // namespace fogline::tcpq
