// LCM behind one small class: the URL with safe options, channel names taken literally, receive
// queues without LCM's limit of 30, and handlers that may throw.
#pragma once

#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "services/runtime/clock.h"
#include "services/runtime/wire.h"

struct _lcm_t;
struct _lcm_recv_buf_t;

namespace fogline {

/// One connection to an LCM network, for one thread. memq:// connects only its own subscribers.
class Bus {
 public:
  using Handler = std::function<void(Bytes)>;

  /// @param url as LCM takes it. udpm gets ttl=0 (this machine only) and asks for a receive buffer
  ///     of 2 MiB (the kernel grants net.core.rmem_max) unless the URL says otherwise.
  /// @throws InputError when LCM cannot open it
  explicit Bus(const std::string& url);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Calls `handler` from Wait() for every message on exactly this channel; the bytes are valid
  /// during the call. What it throws comes out of Wait().
  void Subscribe(std::string_view channel, Handler handler);

  /// Sends bytes; they are copied before it returns.
  void Publish(std::string_view channel, Bytes bytes);

  /// Handles one message, waiting for it up to `timeout`. @return whether there was one.
  bool Wait(Duration timeout);

  /// Handles the messages that are there, but no more than kDrained: those that memq's handlers
  /// publish come in turn, and a run in memory would never let its caller look at the clock.
  void Drain();
  static constexpr int kDrained = 1000;

  /// Readable when Wait(0) would handle a message.
  int fd() const { return fd_; }
  const std::string& url() const { return url_; }

 private:
  struct Subscription {
    Bus* bus;
    Handler handler;
  };
  bool Readable(Duration timeout) const;
  static void OnMessage(const _lcm_recv_buf_t* buffer, const char* channel, void* subscription);

  std::string url_;
  _lcm_t* lcm_ = nullptr;
  int fd_ = -1;
  std::vector<int> sockets_;                     // LCM's UDP sockets; it owns them
  std::set<std::string, std::less<>> channels_;  // subscribed
  // Of memq, which nobody but this object publishes on: messages that wait to be handled.
  bool in_memory_;
  std::int64_t waiting_ = 0;
  std::deque<Subscription> subscriptions_;  // stable addresses: LCM keeps pointers to them
  std::exception_ptr parked_;               // may not pass through LCM's C code
};

/// A multicast URL of this machine only, on a port drawn at random: runs do not meet by chance.
std::string FreshMulticastUrl();

}  // namespace fogline
