// LCM behind one small class: the URL with safe options, channel names taken literally, receive
// queues without LCM's limit of 30, handlers that may throw; on request signatures and a bad
// network.
#pragma once

#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/runtime/arrival.h"
#include "services/runtime/channel_filter.h"
#include "services/runtime/clock.h"
#include "services/runtime/faults.h"
#include "services/runtime/lcm_sockets.h"
#include "services/runtime/seal.h"

struct _lcm_t;
struct _lcm_recv_buf_t;

namespace fogline {

namespace tcpq {
class Client;
}

/// One connection to an LCM network, for one thread. memq:// connects only its own subscribers.
class Bus {
 public:
  using Handler = std::function<void(Arrival&)>;

  /// @param url as LCM takes it. udpm gets ttl=0 (this machine only) and asks for a receive buffer
  ///     of 2 MiB (the kernel grants net.core.rmem_max) unless the URL says otherwise. tcpq's host
  ///     may be a name; url() has it in numbers.
  /// @throws InputError when LCM cannot open it, std::runtime_error if there is no tcpq relay
  explicit Bus(const std::string& url);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// From now on signs what it sends, and refuses what is not signed well.
  /// @throws InputError where the kernel keeps nothing from LCM's parser, which comes before the
  ///     signature: with mpudpm, or if it takes no filter
  void Secure(const Seal& seal);
  bool secured() const { return seal_.has_value(); }
  /// From now on receives as over a bad network.
  void Impair(const Faults& faults) { faults_ = faults; }

  /// Calls `handler` from Wait() for every message on exactly this channel, handlers of one channel
  /// in the order of their subscription; what the message holds is valid during the call. What a
  /// handler throws comes out of Wait().
  /// @param contents what `handler` needs; where the kernel can, it drops the others of the channel
  void Subscribe(std::string_view channel, Handler handler, const Contents& contents = {});

  /// Takes a share of a channel only, in [0, 1], as far as the kernel can choose. 1: all of it.
  void Thin(std::string_view channel, double share);

  /// Calls `watcher` from Wait() for every message on any channel that is no larger than ours may
  /// be. Once at most.
  using Watcher = std::function<void(std::string_view channel, Bytes)>;
  void SubscribeAll(Watcher watcher);

  /// Sends bytes; they are copied before it returns. What cannot be sent is lost, as on a bad
  /// network, and counted.
  /// @throws std::runtime_error if there are more than kMaxMessageBytes
  void Publish(std::string_view channel, Bytes bytes) { Publish(TopicOf(channel), bytes); }

  /// A channel on this bus, for those that publish often: finding it by name takes its time.
  struct Topic;
  Topic& TopicOf(std::string_view channel);
  void Publish(const Topic& topic, Bytes bytes);

  /// Messages that could not be sent.
  struct FailedSends {
    std::int64_t count = 0;          // since the beginning
    std::string error;               // why the last one could not
    std::optional<TimePoint> since;  // nothing could be sent since then; none if the last one was
  };
  const FailedSends& failed_sends() const { return failed_sends_; }

  /// Handles one message, waiting for it up to `timeout`. @return whether there was one.
  bool Wait(Duration timeout);

  /// Handles the messages that are there, but no more than kDrained: those that memq's handlers
  /// publish come in turn, and a run in memory would never let its caller look at the clock.
  void Drain();
  static constexpr int kDrained = 1000;

  /// Messages that were not verified.
  struct Unverified {
    std::int64_t not_signed = 0;    // refused: there is a key here
    std::int64_t badly_signed = 0;  // refused
    std::int64_t no_key = 0;        // signed, and there is no key here: the decoder refuses them
  };
  /// Since the beginning.
  const Unverified& unverified() const { return unverified_; }
  /// Since the last call: for those who share a bus and count together.
  Unverified TakeUnverified() { return std::exchange(not_taken_, {}); }

  /// Readable when Wait(0) would handle a message; with tcpq, if all before are handled.
  int fd() const { return fd_; }
  const std::string& url() const { return url_; }

 private:
  bool Readable(Duration timeout);
  void OnFailedSend(int error);
  void OnSentAgain();
  void JoinAgainIfSilent();
  void Handle();
  bool HandleDue();
  /// What the signature vouches for; nothing if the message is refused.
  std::optional<Bytes> Verified(const Topic& topic, Bytes bytes);
  void CallHandlers(Topic& topic, Bytes bytes);
  void FilterSockets();
  /// @throws std::runtime_error where the kernel has filtered until now and will not go on
  void Filter(const std::vector<sock_filter>& program);
  static void OnMessage(const _lcm_recv_buf_t* buffer, const char* channel, void* topic);
  static void Deliver(Bytes bytes, Topic& topic);
  static void OnAnything(const _lcm_recv_buf_t* buffer, const char* channel, void* bus);
  void Watch(std::string_view channel, Bytes bytes);

  std::string url_;
  _lcm_t* lcm_ = nullptr;               // one of both
  std::unique_ptr<tcpq::Client> tcpq_;  // instead of LCM's own
  int fd_ = -1;
  std::vector<int> sockets_;  // LCM's UDP sockets; it owns them
  bool filtered_ = true;      // the kernel filters what reaches LCM's parser
  // Where the group is heard and reached as the route leads, which may change; and when it was seen
  // to last that it is joined there.
  std::optional<GroupMembership> membership_;
  TimePoint joined_{};
  FailedSends failed_sends_;
  // Of memq, which nobody but this object publishes on: messages that wait to be handled.
  bool in_memory_;
  std::int64_t waiting_ = 0;
  TimePoint now_{};            // when Wait() handled a message last
  std::deque<Topic> topics_;   // stable addresses: LCM keeps pointers to them
  Watcher watcher_;            // of all channels, if there is one
  std::exception_ptr parked_;  // may not pass through LCM's C code
  std::optional<Seal> seal_;
  std::optional<Faults> faults_;
  Unverified unverified_;
  Unverified not_taken_;
};

/// What the user of a process should know about keys and signatures, "" if there is nothing.
std::string SignatureTrouble(const Bus::Unverified& unverified);

/// LCM knows of one subscription however many handlers there are: a message is dispatched once and
/// decoded once.
struct Bus::Topic {
  Bus* bus;
  std::string channel;
  Arrival arrival;
  std::vector<Handler> handlers;
  Contents wanted;  // by all handlers
  double share = 1;
};

/// A multicast URL of this machine only, on a port drawn at random: runs do not meet by chance.
std::string FreshMulticastUrl();

}  // namespace fogline
