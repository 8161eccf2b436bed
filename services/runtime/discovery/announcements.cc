#include "services/runtime/discovery/announcements.h"

#include <algorithm>
#include <functional>
#include <optional>

#include <fmt/core.h>

#include "common/text.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/wire/refusals.h"

namespace fogline::runtime {
namespace {

// A beacon says when its run began. The listener accepts a time that is at most this far in the
// future. Runner and listener read the same clock, but this clock may be set back between the two
// readings.
constexpr std::int64_t kClockSlack_us = 1'000'000;

/// The roles with these names; nullopt if a name is unknown or occurs twice.
std::optional<std::vector<Role>> RolesOf(const std::vector<std::string>& names) {
  std::vector<Role> roles;
  for (const RoleInfo& info : kRoles) {
    if (std::ranges::find(names, info.name) != names.end()) roles.push_back(info.role);
  }
  if (roles.size() != names.size()) return std::nullopt;
  return roles;
}

}  // namespace

bool Announcement::Awaits(Role role) const {
  return std::ranges::find(awaited, role) != awaited.end();
}

std::string Announcement::Text() const {
  std::string text = fmt::format("run {} at {}, scenario {}, announced by pid {} on {}", run_id,
                                 url, Printable(scenario), pid, Printable(host));
  for (const Role role : awaited) {
    text +=
        fmt::format("{} the {}", role == awaited.front() ? "; it waits for" : ",", NameOf(role));
  }
  return text;
}

void Announcements::Hear(Bytes bytes, TimePoint now, std::int64_t wall_us) {
  if (!Take(bytes, now, wall_us)) ++refused_;
}

bool Announcements::Take(Bytes bytes, TimePoint now, std::int64_t wall_us) {
  beacon_t beacon{};
  if (bytes.size() > kMaxMessageBytes || Examine(bytes, beacon) != nullptr) return false;
  const auto roles = RolesOf(beacon.awaited);
  const bool sound = beacon.header.run_id > 0 && beacon.pid > 0 && beacon.began_us > 0 &&
                     beacon.began_us <= wall_us + kClockSlack_us && beacon.host == host_ && roles &&
                     beacon.scenario.size() <= kMaxTitle && IsUtf8(beacon.scenario) &&
                     !HasControlCharacter(beacon.scenario) && MayBeAnnounced(beacon.url);
  if (!sound) return false;
  std::erase_if(entries_, [now](const Entry& entry) { return now - entry.heard > kGone; });
  const auto known = std::ranges::find_if(entries_, [&beacon](const Entry& entry) {
    return entry.announcement.run_id == beacon.header.run_id;
  });
  if (known != entries_.end()) {
    // A run does not change its URL or its runner, so a beacon with other values is refused.
    const Announcement& run = known->announcement;
    if (run.url != beacon.url || run.pid != beacon.pid || run.began_us != beacon.began_us) {
      return false;
    }
    if (beacon.over) {
      entries_.erase(known);
      return true;
    }
    known->announcement.awaited = *roles;
    known->heard = now;
    ++known->times;
    return true;
  }
  if (beacon.over) return true;
  Keep({.run_id = beacon.header.run_id,
        .began_us = beacon.began_us,
        .url = beacon.url,
        .scenario = beacon.scenario,
        .host = beacon.host,
        .pid = beacon.pid,
        .awaited = *roles},
       now);
  return true;
}

void Announcements::Keep(Announcement announcement, TimePoint now) {
  if (entries_.size() == kMax) {
    // Forgets the oldest of the runs with the fewest beacons.
    entries_.erase(std::ranges::min_element(entries_, {}, &Entry::times));
  }
  entries_.push_back({.announcement = std::move(announcement), .heard = now, .times = 1});
}

std::vector<Announcement> Announcements::Current(TimePoint now) const {
  std::vector<Announcement> current;
  for (const Entry& entry : entries_) {
    if (now - entry.heard <= kGone) current.push_back(entry.announcement);
  }
  std::ranges::stable_sort(current, std::greater{}, &Announcement::began_us);
  return current;
}

}  // namespace fogline::runtime
