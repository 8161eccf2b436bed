#include "services/runtime/discovery/meeting_sender.h"

#include <lcm/lcm.h>

#include "services/runtime/transport/lcm_sockets.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/transport/multicast_route.h"

namespace fogline::runtime {

MeetingSender::MeetingSender(const std::string& own_url) {
  const std::string meeting = MeetingUrl();
  const auto address = ParseMulticastUrl(meeting);
  if (!address || SameNetwork(meeting, own_url)) return;
  const std::string url = UrlOnThisMachine(*address);
  if (!WhyNoMulticast(url).empty()) return;
  const LcmSockets sockets(ReachOf(url));
  lcm_ = lcm_create(url.c_str());
}

MeetingSender::~MeetingSender() {
  if (lcm_ != nullptr) lcm_destroy(lcm_);
}

void MeetingSender::Publish(std::string_view channel, Bytes bytes) {
  if (lcm_ == nullptr) return;
  static_cast<void>(lcm_publish(lcm_, std::string(channel).c_str(), bytes.data(),
                                static_cast<unsigned>(bytes.size())));
}

}  // namespace fogline::runtime
