#include "services/runtime/transport/bus.h"

#include <lcm/lcm.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/file.h"
#include "common/process/poll.h"
#include "services/runtime/transport/lcm_sockets.h"
#include "services/runtime/transport/tcpq_client.h"
#include "services/runtime/wire/channel_filter.h"

namespace fogline::runtime {
namespace {

/// Escapes a channel name, because LCM treats channel names as regular expressions.
std::string Escaped(std::string_view channel) {
  std::string escaped;
  for (const char c : channel) {
    if (std::string_view(R"(\^$.|?*+()[]{}-#)").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// Sets a flag while an object of this class exists.
class FlagSet {
 public:
  explicit FlagSet(bool& flag) : flag_(flag) { flag_ = true; }
  ~FlagSet() { flag_ = false; }
  FlagSet(const FlagSet&) = delete;
  FlagSet& operator=(const FlagSet&) = delete;

 private:
  bool& flag_;
};

// A bus that receives nothing for this long renews its membership of the multicast group, because
// it may have lost the membership. In this time every process of a run sends five messages.
constexpr Duration kJoinAgainEvery = milliseconds(1000);

}  // namespace

void Bus::KeepBacklog() {
  if (!inbox_ || inbox_->keeps_backlog()) return;
  try {
    inbox_->KeepBacklog();
  } catch (const std::system_error& error) {
    ThrowIfExhausted(error.code().value(), url_);
    throw std::runtime_error(
        fmt::format("cannot keep a backlog of {}: {}", url_, error.code().message()));
  }
  fd_ = inbox_->fd();
  ++replaced_;
}

std::int64_t Bus::replaced() const { return tcpq_ ? tcpq_->replaced() : replaced_; }

std::string Bus::WhyCutOff() const { return tcpq_ && tcpq_->lost() ? tcpq_->trouble() : ""; }

void RequireSignable(std::string_view url) {
  if (!url.starts_with("mpudpm://")) return;
  throw InputError(
      "error: --key: mpudpm has no filter, so every message reaches LCM's parser; use udpm");
}

void Bus::Secure(const MessageSigner& signer) {
  RequireSignable(url_);
  if (!filtered_) {
    throw InputError(
        "error: --key: the kernel accepts no socket filter, which keeps fragments and floods from "
        "a process; `fogline doctor` says more");
  }
  signer_ = signer;
}

Bus::Topic& Bus::TopicOf(std::string_view channel) {
  const auto found = std::ranges::find(topics_, channel, &Topic::channel);
  if (found != topics_.end()) return *found;
  return topics_.emplace_back(Topic{.bus = this, .channel = std::string(channel)});
}

void Bus::Subscribe(std::string_view channel, Handler handler, const Contents& contents) {
  Topic& topic = TopicOf(channel);
  topic.handlers.push_back(std::move(handler));
  if (topic.handlers.size() > 1) {
    topic.wanted = {};  // several readers: take the whole channel
    return FilterSockets();
  }
  topic.wanted = contents;
  if (tcpq_) {
    return tcpq_->Subscribe(channel, Escaped(channel),
                            [&topic](Bytes bytes) { Deliver(bytes, topic); });
  }
  if (!inbox_) SubscribeThroughLcm(topic);
  FilterSockets();
}

void Bus::SubscribeThroughLcm(Topic& topic) {
  lcm_subscription_t* handle =
      lcm_subscribe(lcm_.get(), Escaped(topic.channel).c_str(), &Bus::OnMessage, &topic);
  if (handle == nullptr) {
    throw std::runtime_error(fmt::format("cannot subscribe to {}", topic.channel));
  }
  lcm_subscription_set_queue_capacity(handle, 0);  // 0: no limit (LCM's default: 30)
}

void Bus::SetSampleRate(std::string_view channel, double share) {
  TopicOf(channel).share = share;
  FilterSockets();
}

void Bus::FilterSockets() {
  if (watcher_) return;  // the watcher takes every channel
  std::vector<Wanted> wanted;
  for (const Topic& topic : topics_) {
    if (!topic.handlers.empty()) wanted.push_back({topic.channel, topic.wanted, topic.share});
  }
  Filter(ChannelFilter(wanted));
}

void Bus::Filter(const std::vector<sock_filter>& program) {
  if (!inbox_ || !filtered_ || AttachFilter(inbox_->socket(), program)) return;
  throw std::runtime_error(fmt::format("the kernel refuses a filter of {} instructions: {}",
                                       program.size(), std::strerror(errno)));
}

void Bus::SubscribeAll(Watcher watcher) {
  watcher_ = std::move(watcher);
  if (tcpq_) {
    return tcpq_->SubscribeAll(
        [this](std::string_view channel, Bytes bytes) { Watch(channel, bytes); });
  }
  if (inbox_) {
    KeepBacklog();
  } else {
    lcm_subscription_t* handle = lcm_subscribe(lcm_.get(), ".*", &Bus::OnAnything, this);
    if (handle == nullptr) throw std::runtime_error("cannot subscribe to all channels");
    lcm_subscription_set_queue_capacity(handle, 0);
  }
  Filter(AnyChannelFilter());
}

void Bus::Publish(const Topic& topic, Bytes bytes) {
  if (bytes.size() > kMaxMessageBytes) {
    throw std::runtime_error(fmt::format("{} takes {} bytes, at most {} fit", topic.channel,
                                         bytes.size(), kMaxMessageBytes));
  }
  if (signer_) bytes = signer_->Sign(topic.channel, bytes);
  errno = 0;
  const bool sent = tcpq_ ? tcpq_->Publish(topic.channel, bytes)
                          : lcm_publish(lcm_.get(), topic.channel.c_str(), bytes.data(),
                                        static_cast<unsigned>(bytes.size())) == 0;
  if (!sent) return OnFailedSend(errno);
  if (failed_sends_.since) OnSentAgain();
  if (in_memory_ && !topic.handlers.empty()) ++waiting_;
}

void Bus::OnFailedSend(int error) {
  ++failed_sends_.count;
  failed_sends_.error = tcpq_ ? tcpq_->trouble() : std::strerror(error);
  if (!failed_sends_.since) failed_sends_.since = Clock::now();
}

void Bus::OnSentAgain() {
  failed_sends_.since.reset();
  if (membership_) membership_->Renew();
}

void Bus::JoinAgainIfSilent() {
  const TimePoint now = Clock::now();
  if (now - std::max(now_, joined_) < kJoinAgainEvery) return;
  joined_ = now;
  membership_->Renew();
}

bool Bus::Wait(Duration timeout) {
  RequireNoHandler();
  if (faults_) {
    if (HandleDue()) return true;
    timeout = std::min(timeout, faults_->NextDue() - Clock::now());
  }
  if (waiting_ == 0 && !Readable(timeout)) {
    if (membership_) JoinAgainIfSilent();
    return faults_ && HandleDue();
  }
  now_ = Clock::now();
  Handle();
  return true;
}

void Bus::RequireNoHandler() const {
  if (handling_) throw std::logic_error("a handler of a bus waits for a message of the same bus");
}

void Bus::Handle() {
  const FlagSet handling(handling_);
  if (waiting_ > 0) --waiting_;
  if (tcpq_) {
    tcpq_->Handle();
  } else if (inbox_) {
    HandlePacket();
  } else if (lcm_handle(lcm_.get()) != 0) {
    throw std::runtime_error(fmt::format("LCM lost {}", url_));
  }
  if (parked_) std::rethrow_exception(std::exchange(parked_, nullptr));
}

void Bus::HandlePacket() {
  const MessageSocket::Message message = inbox_->Take().value();
  if (watcher_) Watch(message.channel, message.data);
  if (Topic* topic = SubscribedTopic(message.channel)) Deliver(message.data, *topic);
}

Bus::Topic* Bus::SubscribedTopic(std::string_view channel) {
  const auto topic = std::ranges::find(topics_, channel, &Topic::channel);
  return topic == topics_.end() || topic->handlers.empty() ? nullptr : &*topic;
}

bool Bus::HasPacket(Duration timeout) {
  if (filtered_ || watcher_) return inbox_->Wait(timeout);
  // Without a filter, the bus also receives messages that no handler reads. After this many of
  // these messages the function returns, so that the caller can do its other work.
  constexpr int kMostOthers = 100;
  const TimePoint end = Clock::now() + timeout;
  for (int i = 0; i < kMostOthers && inbox_->Wait(end - Clock::now()); ++i) {
    if (SubscribedTopic(inbox_->message()->channel) != nullptr) return true;
    inbox_->Take();
  }
  return false;
}

bool Bus::HandleDue() {
  now_ = Clock::now();
  const auto message = faults_->Due(now_);
  const FlagSet handling(handling_);
  if (message) CallHandlers(TopicOf(message->channel), message->bytes);
  return message.has_value();
}

bool Bus::Readable(Duration timeout) {
  if (tcpq_) return tcpq_->Readable(timeout);
  if (inbox_) return HasPacket(timeout);
  const int ready = PollFor(fd_, POLLIN, timeout);
  if (ready < 0 && errno != EINTR) throw std::runtime_error("cannot wait for messages");
  return ready > 0;
}

void Bus::Drain() {
  RequireNoHandler();
  for (int i = 0; i < kDrained; ++i) {
    if (waiting_ > 0) {
      Handle();  // memq: faster than Wait(), which also reads the clock
    } else if (!Wait(Duration::zero())) {
      return;
    }
  }
}

void Bus::OnMessage(const _lcm_recv_buf_t* buffer, const char* /*channel*/, void* topic) {
  Deliver({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size},
          *static_cast<Topic*>(topic));
}

void Bus::Deliver(Bytes bytes, Topic& topic) {
  Bus& bus = *topic.bus;
  try {
    if (bus.faults_) {
      bus.faults_->Take(topic.channel, bytes, bus.now_);
    } else {
      bus.CallHandlers(topic, bytes);
    }
  } catch (...) {
    bus.parked_ = std::current_exception();
  }
}

void Bus::OnAnything(const _lcm_recv_buf_t* buffer, const char* channel, void* bus) {
  static_cast<Bus*>(bus)->Watch(
      channel, {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
}

void Bus::Watch(std::string_view channel, Bytes bytes) {
  try {
    watcher_(channel, bytes);
  } catch (...) {
    parked_ = std::current_exception();
  }
}

void Bus::CallHandlers(Topic& topic, Bytes bytes) {
  if (signer_ || LooksSigned(bytes)) {
    const auto verified = Verified(topic, bytes);
    if (!verified) return;
    bytes = *verified;
  }
  topic.arrival.Renew(bytes, now_);
  for (const Handler& handler : topic.handlers) handler(topic.arrival);
}

std::optional<Bytes> Bus::Verified(const Topic& topic, Bytes bytes) {
  const auto count = [this](std::int64_t Unverified::*kind) {
    ++(unverified_.*kind);
    ++(not_taken_.*kind);
  };
  if (!signer_) {
    // Without a key, the bytes go to the decoder as they are. The decoder refuses a payload that is
    // followed by a signature. But an unsigned payload may end like a signature by chance. The
    // decoder must still read such a payload.
    count(&Unverified::no_key);
    return bytes;
  }
  const MessageSigner::Opened opened = signer_->Open(topic.channel, bytes);
  if (opened.verdict == MessageSigner::Verdict::kGood) return opened.payload;
  count(opened.verdict == MessageSigner::Verdict::kNotSigned ? &Unverified::not_signed
                                                             : &Unverified::badly_signed);
  return std::nullopt;
}

std::string SignatureTrouble(const Bus::Unverified& unverified) {
  if (unverified.badly_signed > 0) {
    return fmt::format(
        "{} messages with a wrong signature were refused: do all processes have the same key?",
        unverified.badly_signed);
  }
  if (unverified.not_signed > 0) {
    return fmt::format(
        "{} messages without a signature were refused: do all processes have the key?",
        unverified.not_signed);
  }
  if (unverified.no_key > 0) return "traffic on this network is signed; give --key";
  return "";
}

}  // namespace fogline::runtime
