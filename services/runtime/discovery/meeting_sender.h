// Sends messages to the meeting address (lcm_url.h), where programs without a URL listen.
#pragma once

#include <string>
#include <string_view>

#include "services/runtime/wire/wire.h"

struct _lcm_t;

namespace fogline::runtime {

/// Sends messages to the meeting address (MeetingUrl()). The messages stay on this machine (ttl=0),
/// even if the meeting address has another ttl. The messages are never signed. A message that
/// cannot be sent is lost.
class MeetingSender {
 public:
  /// Sends nothing if `own_url` is the meeting address itself, or if the meeting address is not a
  /// multicast group or has no route. @param own_url the network that the messages name
  explicit MeetingSender(const std::string& own_url);
  ~MeetingSender();
  MeetingSender(const MeetingSender&) = delete;
  MeetingSender& operator=(const MeetingSender&) = delete;

  bool is_open() const { return lcm_ != nullptr; }
  void Publish(std::string_view channel, Bytes bytes);

 private:
  // The sender uses LCM directly and not a Bus. A Bus always opens a socket that receives, and
  // tests that its own messages come back. LCM does neither if it is only used to send.
  _lcm_t* lcm_ = nullptr;
};

}  // namespace fogline::runtime
