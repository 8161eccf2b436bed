#include "services/runtime/discovery/beacon.h"

#include <lcm/lcm.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include <fmt/core.h>

#include "common/process/this_process.h"
#include "common/text.h"
#include "services/runtime/transport/lcm_sockets.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/transport/multicast_route.h"

namespace fogline::runtime {
namespace {

std::int64_t WallMicroseconds() {
  using std::chrono::microseconds;
  return duration_cast<microseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// The title as a beacon contains it. A title that is too long is cut between two characters.
std::string TitleOf(const std::string& scenario) {
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; };
  std::string title = EscapeControls(scenario);
  if (title.size() <= Announcements::kMaxTitle) return title;
  std::size_t end = Announcements::kMaxTitle;
  while (end > 0 && continues(title[end])) --end;
  return title.substr(0, end);
}

/// The URL to send beacons to; nullopt if beacons cannot or need not be sent.
std::optional<std::string> BeaconUrl(const std::string& run_url) {
  const std::string meeting = MeetingUrl();
  const auto address = ParseMulticastUrl(meeting);
  if (!address || SameNetwork(meeting, run_url) || !MayBeAnnounced(run_url)) return std::nullopt;
  const std::string url = fmt::format("udpm://{}:{}?ttl=0", address->group, address->port);
  return WhyNoMulticast(url).empty() ? std::optional(url) : std::nullopt;
}

}  // namespace

Beacon::Beacon(Announcement run) {
  beacon_.header.run_id = run.run_id;
  beacon_.began_us = WallMicroseconds();
  beacon_.url = std::move(run.url);
  beacon_.scenario = TitleOf(run.scenario);
  beacon_.host = HostName();
  beacon_.pid = getpid();
  const auto url = BeaconUrl(beacon_.url);
  if (!url) return;
  const LcmSockets sockets({}, ReachOf(*url));
  lcm_ = lcm_create(url->c_str());
}

Beacon::~Beacon() {
  if (lcm_ == nullptr) return;
  beacon_.over = 1;
  Publish();
  lcm_destroy(lcm_);
}

void Beacon::Send(TimePoint now, const std::vector<Role>& awaited) {
  due_ = now + kBeaconEvery;
  beacon_.awaited.clear();
  for (const Role role : awaited) beacon_.awaited.emplace_back(NameOf(role));
  beacon_.num_awaited = static_cast<std::int32_t>(beacon_.awaited.size());
  Publish();
}

void Beacon::Publish() {
  Encode(beacon_, buffer_);
  static_cast<void>(lcm_publish(lcm_, std::string(kBeaconChannel).c_str(), buffer_.data(),
                                static_cast<unsigned>(buffer_.size())));
}

BeaconListener::BeaconListener(const std::string& meeting_url) : announcements_(HostName()) {
  if (!ParseMulticastUrl(meeting_url)) return;
  bus_.emplace(meeting_url);
  bus_->Subscribe(kBeaconChannel, [this](Bytes bytes) {
    const TimePoint now = Clock::now();
    if (const auto share = shedder_.Count(now)) bus_->SetSampleRate(kBeaconChannel, *share);
    announcements_.Hear(bytes, now, WallMicroseconds());
  });
}

void BeaconListener::Look() {
  if (bus_) bus_->Drain();
}

}  // namespace fogline::runtime
