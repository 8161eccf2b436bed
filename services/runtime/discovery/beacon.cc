#include "services/runtime/discovery/beacon.h"

#include <unistd.h>

#include <chrono>
#include <utility>

#include "common/process/this_process.h"
#include "common/text.h"
#include "services/runtime/transport/lcm_url.h"

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

}  // namespace

Beacon::Beacon(Announcement run)
    // A MeetingSender whose network is the meeting address sends nothing. If the run's URL must not
    // be announced, sender_ becomes such a MeetingSender.
    : sender_(MayBeAnnounced(run.url) ? run.url : MeetingUrl()) {
  beacon_.header.run_id = run.run_id;
  beacon_.began_us = WallMicroseconds();
  beacon_.url = std::move(run.url);
  beacon_.scenario = TitleOf(run.scenario);
  beacon_.host = HostName();
  beacon_.pid = getpid();
}

Beacon::~Beacon() {
  beacon_.over = 1;
  Publish();
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
  sender_.Publish(kBeaconChannel, buffer_);
}

BeaconListener::BeaconListener(const std::string& meeting_url) : announcements_(HostName()) {
  const auto address = ParseMulticastUrl(meeting_url);
  if (!address) return;
  // A beacon does not leave its machine (MeetingSender). The kernel delivers it only if a socket of
  // this machine has joined the group on loopback.
  bus_.emplace(UrlOnThisMachine(*address));
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
