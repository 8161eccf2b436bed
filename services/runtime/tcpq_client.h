// A client of a tcpq relay that takes the place of LCM's own, which aborts when the relay ends,
// waits without limit for a server that says nothing, takes five system calls and packets for a
// message, and loses its connection to a signal. It speaks the same protocol with the same relays.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/runtime/clock.h"
#include "services/runtime/tcpq_frame.h"
#include "services/runtime/tcpq_url.h"
#include "services/runtime/wire.h"

namespace fogline::tcpq {

/// The relay has ended, or does not work any more, and does not come back.
class ConnectionLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One connection, for one thread.
///
/// A lost one is made again by Readable(), as soon as the relay is back; what is published
/// meanwhile is lost, and what others publish. If it is not back after kTries, ConnectionLost says
/// so, once, out of Readable(). From then on that only waits, so that a run can be ended in order.
class Client {
 public:
  using Handler = std::function<void(Bytes)>;

  /// A relay that was killed is started again within a second, unless the machine is short of
  /// processes; a person who does it takes longer than anybody waits.
  static constexpr Duration kTryEvery = milliseconds(50);
  static constexpr int kTries = 200;

  /// Connects to the relay of a tcpq URL; messages above `limits` lose the connection.
  /// @throws InputError for a bad URL or an unknown host, std::runtime_error if there is no relay
  explicit Client(const std::string& url, const Limits& limits = {});
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Calls `handler` from Handle() for every message on exactly this channel that is published
  /// after the relay knows of it. The relay gives a publisher its own messages too.
  /// @param pattern the regular expression for this channel
  void Subscribe(std::string_view channel, std::string_view pattern, Handler handler);

  /// Calls `watcher` from Handle() for every message that is published on any channel after the
  /// relay knows of it. Once at most.
  using Watcher = std::function<void(std::string_view channel, Bytes)>;
  void SubscribeAll(Watcher watcher);

  /// Sends a message. While the relay takes nothing, what it sends is kept, so that both do not
  /// wait for each other. @return false if the connection is lost
  bool Publish(std::string_view channel, Bytes bytes);

  /// Waits up to `timeout` for a message; less if only a part of one comes. @return whether one is
  /// there
  bool Readable(Duration timeout);

  /// Handles the message that is there, if any.
  void Handle();

  /// Stays the same when the connection is made again.
  int fd() const { return fd_; }
  /// Why the connection was lost last.
  const std::string& trouble() const { return trouble_; }
  /// In numbers, as LCM's programs need it.
  std::string url() const { return endpoint_.Url(); }

 private:
  class Lost;
  /// A socket that is connected to the relay.
  int Connect(Duration limit) const;
  /// Says that this is a client and what it wants, and waits until the relay has answered.
  void Greet(Duration limit);
  void Subscribe(std::string_view pattern);
  bool Ready(short events, Duration timeout) const;
  void SendFrame();
  void Receive();
  bool Parse();
  /// Tries to connect again when it is time to. @return whether the relay is back
  bool ConnectAgain(Duration timeout);
  /// Until the relay is back nothing is sent or received.
  void Lose(const Lost& lost);
  /// fd_ is this file from now on.
  void BeReplacedBy(int file);

  Endpoint endpoint_;
  int fd_ = -1;
  Limits limits_;
  FrameParser parser_;
  std::optional<Frame> next_;           // to be handled
  std::vector<std::uint8_t> chunk_;     // of the kernel
  std::vector<std::uint8_t> received_;  // not yet parsed: a handler still looks at a frame
  std::vector<std::uint8_t> frame_;     // being sent
  std::size_t sent_unread_ = 0;         // bytes since it was looked what has come
  std::vector<std::string> patterns_;   // that the relay knows of
  std::vector<std::pair<std::string, Handler>> handlers_;
  Watcher watcher_;
  bool lost_ = false;
  std::string trouble_;
  int tries_ = 0;  // to connect again
  TimePoint try_at_{};
};

}  // namespace fogline::tcpq
