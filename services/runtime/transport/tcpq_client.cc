#include "services/runtime/transport/tcpq_client.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include <fmt/core.h>

#include "common/file.h"
#include "common/process/poll.h"

namespace fogline::runtime::tcpq {
namespace {

// A relay must answer within kAnswerLimit, and accept a byte within kStallLimit.
constexpr Duration kAnswerLimit = milliseconds(5000);
constexpr Duration kStallLimit = milliseconds(5000);
// When the client tries to connect to a relay again, this limit replaces kAnswerLimit. A relay that
// was started again answers immediately.
constexpr Duration kSecondAnswerLimit = milliseconds(200);
// The client stores at most this many bytes from the relay while the relay accepts no data.
constexpr std::size_t kMaxReceived = 64 << 20;
// After publishing this many bytes without reading, the client reads, because a relay disconnects
// clients that read nothing.
constexpr std::size_t kReadEvery = 256 << 10;

/// Opens a file that is never readable. The file replaces a lost connection, so that a program that
/// polls the descriptor does not wake up.
int QuietFile() { return eventfd(0, EFD_CLOEXEC); }

std::runtime_error CannotReach(const Endpoint& relay, int error) {
  return std::runtime_error(
      error == ECONNREFUSED
          ? fmt::format("no process listens on {}; start fogline-relay there", relay.ToString())
          : fmt::format("cannot reach {}: {}", relay.ToString(), std::strerror(error)));
}

}  // namespace

/// Thrown inside the client when the connection is lost.
class Client::Lost : public std::runtime_error {
 public:
  Lost(const Endpoint& relay, std::string_view why)
      : std::runtime_error(fmt::format("lost the relay {}: {}", relay.Url(), why)) {}
};

Client::Client(const std::string& url, const Limits& limits)
    : endpoint_(ResolveUrl(url)),
      limits_(limits),
      parser_(kRelayMagic, limits),
      chunk_(kWorthACall) {
  const TimePoint end = Clock::now() + kAnswerLimit;
  try {
    fd_ = BeginConnect();
    while (!Connected(end - Clock::now())) {
      if (Clock::now() >= end) throw CannotReach(endpoint_, ETIMEDOUT);
    }
    Greet();
    while (!Greeted(end - Clock::now())) {
      if (Clock::now() < end) continue;  // a signal ended the wait, or a part of the greeting came
      throw std::runtime_error(
          fmt::format("{} takes connections but does not answer: is it a fogline-relay?",
                      endpoint_.ToString()));
    }
  } catch (...) {
    if (fd_ >= 0) close(fd_);
    throw;
  }
}

Client::~Client() {
  if (fd_ >= 0) close(fd_);
}

int Client::BeginConnect() const {
  const int connection = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (connection < 0) {
    ThrowIfExhausted(errno, endpoint_.ToString());
    throw std::runtime_error(fmt::format("no socket: {}", std::strerror(errno)));
  }
  const int on = 1;  // sends a message without a wait for earlier acknowledgements
  setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint_.port);
  inet_pton(AF_INET, endpoint_.address.c_str(), &address.sin_addr);
  if (connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 &&
      errno != EINPROGRESS) {
    const int error = errno;
    close(connection);
    throw CannotReach(endpoint_, error);
  }
  return connection;
}

bool Client::Connected(Duration timeout) const {
  if (!Ready(POLLOUT, timeout)) return false;
  int error = 0;
  socklen_t size = sizeof(error);
  getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size);
  if (error != 0) throw CannotReach(endpoint_, error);
  return true;
}

void Client::Greet() {
  frame_.clear();
  AppendHello(kClientMagic, frame_);
  for (const std::string& pattern : patterns_) {
    AppendFrame(FrameType::kSubscribe, pattern, {}, frame_);
  }
  SendFrame();
}

bool Client::Greeted(Duration timeout) {
  if (received_.empty()) {
    if (!Ready(POLLIN, timeout)) return false;
    Receive();
  }
  parser_.Append(received_);
  received_.clear();
  if (!parser_.Greeted() && !parser_.error().empty()) throw Lost(endpoint_, parser_.error());
  return parser_.Greeted();
}

void Client::Subscribe(std::string_view channel, std::string_view pattern, Handler handler) {
  handlers_.emplace_back(channel, std::move(handler));
  Subscribe(pattern);
}

void Client::SubscribeAll(Watcher watcher) {
  watcher_ = std::move(watcher);
  Subscribe(".*");
}

void Client::Subscribe(std::string_view pattern) {
  patterns_.emplace_back(pattern);
  if (lost_ && phase_ != Phase::kGreeting) return;  // Greet() will subscribe
  frame_.clear();
  AppendFrame(FrameType::kSubscribe, pattern, {}, frame_);
  try {
    SendFrame();
  } catch (const Lost& lost) {
    Lose(lost);
  }
}

bool Client::Publish(std::string_view channel, Bytes bytes) {
  if (channel.size() > limits_.channel || bytes.size() > limits_.payload) {
    throw std::runtime_error(
        fmt::format("{} bytes on \"{}\" are too many for tcpq", bytes.size(), channel));
  }
  if (lost_) return false;
  frame_.clear();
  AppendFrame(FrameType::kPublish, channel, bytes, frame_);
  try {
    SendFrame();
    return true;
  } catch (const Lost& lost) {
    Lose(lost);
    return false;
  }
}

void Client::SendFrame() {
  std::optional<TimePoint> stalled;
  for (std::size_t sent = 0; sent < frame_.size();) {
    const ssize_t size = send(fd_, frame_.data() + sent, frame_.size() - sent, MSG_NOSIGNAL);
    if (size > 0) {
      sent += static_cast<std::size_t>(size);
      stalled.reset();
      continue;
    }
    if (size < 0 && errno != EAGAIN && errno != EINTR) throw Lost(endpoint_, std::strerror(errno));
    const TimePoint now = Clock::now();
    if (!stalled) stalled = now;
    if (now - *stalled >= kStallLimit) {
      throw Lost(endpoint_,
                 fmt::format("it has accepted no data for {} s", Milliseconds(kStallLimit) / 1000));
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
  if (lost_) return ConnectAgain(timeout) && Parse();
  try {
    if (received_.empty()) {
      if (!Ready(POLLIN, timeout)) return false;
      Receive();
      sent_unread_ = 0;
    }
    parser_.Append(received_);
    received_.clear();
    const bool there = Parse();
    if (!parser_.error().empty()) {
      throw Lost(endpoint_, "it " + parser_.error());
    }
    return there;
  } catch (const Lost& lost) {
    Lose(lost);
    return false;
  }
}

bool Client::Parse() {
  if (!next_) next_ = parser_.Next();
  return next_.has_value();
}

void Client::Handle() {
  if (!Parse()) return;
  const Frame frame = *next_;  // its bytes are valid until Readable() appends other bytes
  next_.reset();
  const std::size_t known = handlers_.size();  // a new handler gets only later messages
  for (std::size_t i = 0; i < known; ++i) {
    const auto& [channel, handler] = handlers_[i];
    if (channel == frame.name) handler(frame.payload);
  }
  if (watcher_) watcher_(frame.name, frame.payload);
}

bool Client::Ready(short events, Duration timeout) const {
  return PollFor(fd_, events, timeout) > 0;
}

void Client::Receive() {
  const ssize_t size = recv(fd_, chunk_.data(), chunk_.size(), 0);
  if (size > 0) received_.insert(received_.end(), chunk_.begin(), chunk_.begin() + size);
  if (size > 0 || (size < 0 && (errno == EAGAIN || errno == EINTR))) return;
  throw Lost(endpoint_, size == 0 ? "it has closed the connection" : std::strerror(errno));
}

void Client::Lose(const Lost& lost) {
  lost_ = true;
  trouble_ = lost.what();
  tries_ = 0;
  phase_ = Phase::kNextTry;
  try_at_ = Clock::now();
  BeReplacedBy(QuietFile());
}

void Client::BeReplacedBy(int file) {
  dup3(file, fd_, O_CLOEXEC);
  close(file);
  ++replaced_;
}

bool Client::ConnectAgain(Duration timeout) {
  if (phase_ == Phase::kNextTry) {
    const TimePoint now = Clock::now();
    const Duration until_try = try_at_ - now;
    if (tries_ > kTries || until_try > timeout) {
      PollFor(-1, 0, timeout);
      return false;
    }
    PollFor(-1, 0, until_try);
    timeout -= std::max(Duration::zero(), until_try);
    if (++tries_ > kTries) throw ConnectionLost(trouble_);
  }
  try {
    return Try(timeout);
  } catch (const std::runtime_error&) {  // the relay is not back yet
    BeReplacedBy(QuietFile());
    phase_ = Phase::kNextTry;
    return false;
  }
}

bool Client::Try(Duration timeout) {
  const TimePoint now = Clock::now();
  if (phase_ == Phase::kNextTry) {
    try_at_ = now + kTryEvery;
    answer_by_ = now + kSecondAnswerLimit;
    parser_ = FrameParser(kRelayMagic, limits_);
    received_.clear();
    next_.reset();
    BeReplacedBy(BeginConnect());
    phase_ = Phase::kConnection;
  }
  if (now >= answer_by_) throw CannotReach(endpoint_, ETIMEDOUT);
  const TimePoint end = now + std::min(timeout, answer_by_ - now);
  if (phase_ == Phase::kConnection) {
    if (!Connected(end - now)) return false;
    Greet();
    phase_ = Phase::kGreeting;
  }
  if (!Greeted(std::max(Duration::zero(), end - Clock::now()))) return false;
  lost_ = false;
  return true;
}

}  // namespace fogline::runtime::tcpq
