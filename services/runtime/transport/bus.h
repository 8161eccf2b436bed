// A small class through which programs use LCM. The class adds safe options to the URL, and takes
// channel names literally. Its receive queues do not have LCM's limit of 30 messages. Handlers may
// throw. On request the class signs messages or simulates a bad network.
//
// With udpm a bus reads its socket itself, because LCM's thread costs a second wake-up for each
// message. Messages then wait in the kernel's buffer and, on request, in a backlog (KeepBacklog()).
// With udpm, LCM only sends. With mpudpm and memq, LCM also receives. With tcpq, LCM is not used
// (tcpq_client.h).
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

#include "common/clock.h"
#include "common/errors.h"
#include "services/runtime/transport/faults.h"
#include "services/runtime/transport/lcm_sockets.h"
#include "services/runtime/transport/udpm/message_socket.h"
#include "services/runtime/wire/arrival.h"
#include "services/runtime/wire/channel_filter.h"
#include "services/runtime/wire/message_signer.h"

struct _lcm_t;
struct _lcm_recv_buf_t;

namespace fogline::runtime::tcpq {
class Client;
}

namespace fogline::runtime {

/// Thrown if this machine has no route for the multicast address of the network's URL. The route
/// may come back later.
class NetworkAway : public InputError {
 public:
  using InputError::InputError;
};

/// Thrown if this machine's own messages to the network do not come back to this machine. A
/// firewall may drop them.
class NetworkClosed : public InputError {
 public:
  using InputError::InputError;
};

/// @throws InputError if a network cannot be used with a key. This is the case for mpudpm: it has
///     no filter, so fragments and floods would reach a process before their signature is checked.
void RequireSignable(std::string_view url);

/// One connection to an LCM network, for one thread. With memq:// a message reaches only the
/// subscribers of the same object.
class Bus {
 public:
  using Handler = std::function<void(Arrival&)>;

  /// @param url in LCM's syntax. If the URL gives no other values, udpm gets ttl=0 (this machine
  ///     only) and a receive buffer of kWideBuffer. The host of tcpq may be a name; url() then
  ///     contains the host's address in numbers.
  /// @throws NetworkAway, NetworkClosed, InputError if the network cannot be opened
  /// @throws std::runtime_error if the tcpq relay cannot be reached
  explicit Bus(const std::string& url);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// From now on, the bus signs the messages that it sends, and refuses messages without a correct
  /// signature.
  /// @throws InputError as RequireSignable(), or if the kernel accepts no filter
  void Secure(const MessageSigner& signer);
  bool secured() const { return signer_.has_value(); }
  /// Starts a backlog: with udpm, a thread takes the messages out of the kernel's buffer
  /// (udpm/backlog.h). So a busy process loses no messages until its backlog is full. But with a
  /// backlog, each message wakes two threads. The backlog is meant for runs in real time, whose
  /// roles do not wait for a busy process. A run in lockstep needs no backlog, because lost
  /// messages are sent again. With the other transports the bus always has a backlog. A handler may
  /// call this function.
  /// @throws std::runtime_error if the kernel grants no thread or no descriptor
  void KeepBacklog();
  /// From now on, the bus simulates a bad network for the messages that it receives (faults.h).
  void Impair(const Faults& faults) { faults_ = faults; }

  /// Calls `handler` from Wait() for every message on exactly this channel. Handlers of one channel
  /// are called in the order of their subscription. The message is valid during the call. If a
  /// handler throws an exception, Wait() throws it.
  /// @param contents the messages that `handler` needs; the kernel drops the other messages of the
  ///     channel, if it accepts a filter and the channel has no other handler
  void Subscribe(std::string_view channel, Handler handler, const Contents& contents = {});

  /// Receives only a share of a channel's messages, if the kernel accepts a filter. The share is in
  /// [0, 1]; 1 means all messages.
  void SetSampleRate(std::string_view channel, double share);

  /// Calls `watcher` from Wait() for every message on any channel, except messages that are too
  /// large for Fogline. Also starts a backlog (KeepBacklog()). SubscribeAll() may be called once at
  /// most.
  using Watcher = std::function<void(std::string_view channel, Bytes)>;
  void SubscribeAll(Watcher watcher);
  /// Whether LCM receives the messages. In this case, LCM stores the name of every channel on which
  /// a message comes. Each name takes about 300 bytes.
  bool LcmReceives() const { return lcm_ != nullptr && !inbox_; }

  /// Sends bytes, which are copied before the call returns. A message that cannot be sent is lost,
  /// as on a bad network, and counted.
  /// @throws std::runtime_error if the message is larger than kMaxMessageBytes
  void Publish(std::string_view channel, Bytes bytes) { Publish(TopicOf(channel), bytes); }

  /// A channel on this bus. A caller that sends many messages keeps a reference to the Topic,
  /// because a search by name takes time.
  struct Topic;
  Topic& TopicOf(std::string_view channel);
  void Publish(const Topic& topic, Bytes bytes);

  /// Messages that could not be sent.
  struct FailedSends {
    std::int64_t count = 0;  // number since the beginning
    std::string error;       // why the last message could not be sent
    // The time since which nothing could be sent; nullopt if the last message was sent.
    std::optional<TimePoint> since;
  };
  const FailedSends& failed_sends() const { return failed_sends_; }

  /// Handles one message. Waits up to `timeout` for the message. @return whether a message came
  /// @throws std::logic_error if a handler of this bus calls it
  bool Wait(Duration timeout);

  /// Handles the messages that have come, but at most kDrained. The limit is for memq, where a
  /// message that a handler publishes comes immediately. Without the limit, Drain() would not
  /// return before the end of a run in memory.
  void Drain();
  static constexpr int kDrained = 1000;

  /// The numbers of messages that have no valid signature, or whose signature this process cannot
  /// verify.
  struct Unverified {
    std::int64_t not_signed = 0;    // refused, because this process has a key
    std::int64_t badly_signed = 0;  // refused
    std::int64_t no_key = 0;        // signed, but this process has no key: the decoder refuses them
  };
  /// The counts since the beginning.
  const Unverified& unverified() const { return unverified_; }
  /// The counts since the last call. If several users of a bus call this function, each user gets a
  /// part of the counts.
  Unverified TakeUnverified() { return std::exchange(not_taken_, {}); }

  /// This descriptor is readable when Wait(0) would handle a message. With tcpq the bus may read
  /// several messages from the descriptor at once. So with tcpq, before the caller waits for this
  /// descriptor, it must handle all messages that have come.
  int fd() const { return fd_; }
  /// A count that grows whenever fd() begins to refer to another file. With tcpq this happens when
  /// the relay is lost or comes back, with udpm in KeepBacklog() and in SubscribeAll(). A caller
  /// that has given a copy of fd() to epoll must then copy fd() again.
  std::int64_t replaced() const;
  const std::string& url() const { return url_; }
  /// Why the relay of tcpq cannot be reached at present; "" if the relay can be reached. Messages
  /// are lost while the relay cannot be reached.
  std::string WhyCutOff() const;

 private:
  void OpenLcm();
  void OpenInbox();
  void TestInbox();
  void SubscribeThroughLcm(Topic& topic);
  bool Readable(Duration timeout);
  bool HasPacket(Duration timeout);
  Topic* SubscribedTopic(std::string_view channel);
  void OnFailedSend(int error);
  void OnSentAgain();
  void JoinAgainIfSilent();
  void RequireNoHandler() const;
  void Handle();
  void HandlePacket();
  bool HandleDue();
  /// The bytes to decode; nullopt if the message is refused. With a key the bytes are the payload,
  /// without a key the whole message.
  std::optional<Bytes> Verified(const Topic& topic, Bytes bytes);
  void CallHandlers(Topic& topic, Bytes bytes);
  void FilterSockets();
  /// @throws std::runtime_error if the kernel refuses a filter although it has accepted earlier
  ///     filters
  void Filter(const std::vector<sock_filter>& program);
  static void OnMessage(const _lcm_recv_buf_t* buffer, const char* channel, void* topic);
  static void Deliver(Bytes bytes, Topic& topic);
  static void OnAnything(const _lcm_recv_buf_t* buffer, const char* channel, void* bus);
  void Watch(std::string_view channel, Bytes bytes);

  struct DestroyLcm {
    void operator()(_lcm_t* lcm) const;
  };

  std::string url_;
  std::unique_ptr<_lcm_t, DestroyLcm> lcm_;  // sends, and receives if inbox_ does not
  std::unique_ptr<tcpq::Client> tcpq_;       // instead of lcm_, with tcpq
  std::optional<MessageSocket> inbox_;       // receives with udpm
  int fd_ = -1;
  std::int64_t replaced_ = 0;
  bool filtered_ = true;  // false if the kernel has refused a filter for inbox_
  // Set if the bus uses the route to the group (LcmSockets::Reach::kRoute). This route may change.
  std::optional<GroupMembership> membership_;
  TimePoint joined_{};  // when a silent bus last renewed its membership
  FailedSends failed_sends_;
  // With memq only this object publishes, and waiting_ is the number of its messages that have not
  // been handled yet.
  bool in_memory_;
  std::int64_t waiting_ = 0;
  TimePoint now_{};            // when Wait() last handled a message
  std::deque<Topic> topics_;   // a deque does not move topics: LCM has pointers to them
  Watcher watcher_;            // called for messages on all channels; may be empty
  bool handling_ = false;      // whether handlers are being called
  std::exception_ptr parked_;  // an exception of a handler; it must not pass through LCM's C code
  std::optional<MessageSigner> signer_;
  std::optional<Faults> faults_;
  Unverified unverified_;
  Unverified not_taken_;
};

/// A text that tells the user of a process what is wrong with keys and signatures; "" if no trouble
/// is known.
std::string SignatureTrouble(const Bus::Unverified& unverified);

/// A channel and its handlers. LCM has one subscription for all handlers of a channel. So a message
/// is dispatched once and decoded once.
struct Bus::Topic {
  Bus* bus;
  std::string channel;
  Arrival arrival;
  std::vector<Handler> handlers;
  Contents wanted;  // the messages that the handlers need
  double share = 1;
};

}  // namespace fogline::runtime
