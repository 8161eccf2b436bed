// A client of a tcpq relay, in place of LCM's own client. LCM's client aborts when the relay ends,
// and waits without limit for a server that sends nothing. It needs five system calls and up to
// five packets for each message, and loses its connection when a signal comes. Fogline's client
// uses the same protocol with the same relays.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/clock.h"
#include "services/runtime/transport/tcpq_url.h"
#include "services/runtime/wire/tcpq_frame.h"
#include "services/runtime/wire/wire.h"

namespace fogline::runtime::tcpq {

/// Thrown if the relay has ended or stopped working, and does not come back.
class ConnectionLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One connection, for one thread.
///
/// Readable() restores a lost connection as soon as the relay is back. A call never waits longer
/// than its `timeout`, except if a relay that is back does not read the greeting. All messages are
/// lost until the connection is restored. If the relay is not back after kTries tries, Readable()
/// throws ConnectionLost, but only once. After that, Readable() only waits, so that the process can
/// end a run properly.
class Client {
 public:
  using Handler = std::function<void(Bytes)>;

  /// The interval and the number of tries to restore a lost connection: 10 s in all. A killed relay
  /// of a run is started again within a second, if the machine can start a process. More tries
  /// would not help: a person needs more time to restart a relay than any role waits.
  static constexpr Duration kTryEvery = milliseconds(50);
  static constexpr int kTries = 200;

  /// Connects to the relay of a tcpq URL. A received message that is larger than `limits` ends the
  /// connection.
  /// @throws InputError for a bad URL or an unknown host, std::runtime_error if there is no relay
  explicit Client(const std::string& url, const Limits& limits = {});
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Calls `handler` from Handle() for every message on exactly this channel that is published
  /// after the relay has got the subscription. The relay sends a message to its publisher, too.
  /// @param pattern the regular expression for this channel
  void Subscribe(std::string_view channel, std::string_view pattern, Handler handler);

  /// Calls `watcher` from Handle() for every message on any channel that is published after the
  /// relay has got the subscription. SubscribeAll() may be called once at most.
  using Watcher = std::function<void(std::string_view channel, Bytes)>;
  void SubscribeAll(Watcher watcher);

  /// Sends a message. While the relay accepts no data, the client stores the bytes that the relay
  /// sends, so that client and relay do not wait for each other.
  /// @return false if the connection is lost
  /// @throws std::runtime_error if the message is larger than the limits
  bool Publish(std::string_view channel, Bytes bytes);

  /// Waits up to `timeout` for a message. The wait ends earlier if only a part of a message comes.
  /// @return whether a message has come
  bool Readable(Duration timeout);

  /// Handles the message that has come, if any.
  void Handle();

  /// The descriptor stays the same when the connection is restored.
  int fd() const { return fd_; }
  /// A count that grows whenever the descriptor begins to refer to another file. A copy of the
  /// descriptor, and an epoll instance, still refer to the old file, which may stay readable for
  /// ever. If the count has grown, make a new copy of the descriptor, or add the descriptor to the
  /// epoll instance again.
  std::int64_t replaced() const { return replaced_; }
  /// Whether the connection is lost at present.
  bool lost() const { return lost_; }
  /// Why the connection was last lost.
  const std::string& trouble() const { return trouble_; }
  /// The URL with the relay's address in numbers. LCM's programs need this form.
  std::string url() const { return endpoint_.Url(); }

 private:
  class Lost;
  /// Begins to connect a socket to the relay. @return the socket
  int BeginConnect() const;
  /// Waits up to `timeout` until the socket is connected. @return whether the socket is connected
  /// @throws std::runtime_error if the relay cannot be reached
  bool Connected(Duration timeout) const;
  /// Sends the client's greeting and its subscriptions.
  void Greet();
  /// Waits up to `timeout` for the relay's greeting. @return whether it has come
  bool Greeted(Duration timeout);
  void Subscribe(std::string_view pattern);
  bool Ready(short events, Duration timeout) const;
  void SendFrame();
  void Receive();
  bool Parse();
  /// Continues the current try to connect again, or begins the next try when it is due. @return
  /// whether the relay is back
  bool ConnectAgain(Duration timeout);
  /// Does the next steps of a try: begins the try, connects, and exchanges greetings. All steps
  /// together wait up to `timeout`. @return whether the relay is back
  bool Try(Duration timeout);
  /// Marks the connection as lost: nothing is sent or received until the relay is back.
  void Lose(const Lost& lost);
  /// Makes fd_ refer to the file that `file` refers to, and closes `file`.
  void BeReplacedBy(int file);

  Endpoint endpoint_;
  int fd_ = -1;
  Limits limits_;
  FrameParser parser_;
  std::optional<Frame> next_;        // the frame to be handled next
  std::vector<std::uint8_t> chunk_;  // buffer for a read from the kernel
  // Received bytes that parser_ does not have yet. A handler may still use the last frame, whose
  // bytes are valid only until parser_ gets further bytes.
  std::vector<std::uint8_t> received_;
  std::vector<std::uint8_t> frame_;    // the frame that is being sent
  std::size_t sent_unread_ = 0;        // bytes sent since the last read
  std::vector<std::string> patterns_;  // subscriptions for the relay
  // A running handler may subscribe, and so add another handler. A deque does not move its elements
  // when an element is added.
  std::deque<std::pair<std::string, Handler>> handlers_;
  Watcher watcher_;
  /// The event for which a lost connection waits: the time of the next try, the connection, or the
  /// greeting of the relay.
  enum class Phase { kNextTry, kConnection, kGreeting };

  bool lost_ = false;
  std::string trouble_;
  int tries_ = 0;  // number of tries to connect again
  Phase phase_ = Phase::kNextTry;
  TimePoint try_at_{};     // the next try
  TimePoint answer_by_{};  // the latest end of the current try
  std::int64_t replaced_ = 0;
};

}  // namespace fogline::runtime::tcpq
