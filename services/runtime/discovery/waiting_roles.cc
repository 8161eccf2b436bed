#include "services/runtime/discovery/waiting_roles.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "services/runtime/wire/message_signer.h"
#include "services/runtime/wire/refusals.h"

namespace fogline::runtime {
namespace {

// Largest length of each text in a WaitingRole, in bytes, before unsafe characters are replaced.
constexpr std::size_t kMaxText = 200;

std::string Safe(const std::string& text) { return Printable(text.substr(0, kMaxText)); }

}  // namespace

void WaitingNotice::Send(status_t status, Bus& bus, TimePoint since, TimePoint now) {
  due_ = now + kWaitingEvery;
  status.header.run_id = 0;
  status.waiting_for = bus.url();
  status.waiting_ms = Milliseconds(now - since);
  Encode(status, buffer_);
  bus.Publish(kWaitingChannel, buffer_);
  if (url_ != bus.url()) {
    url_ = bus.url();
    meeting_.emplace(url_);
  }
  meeting_->Publish(kWaitingChannel, buffer_);
}

std::string WaitingRole::Text() const {
  return fmt::format("{} waits on {}: pid {} on {}, version {}{}", role, url, pid, host, version,
                     same_types ? "" : ", built with other message types");
}

void WaitingRoles::Hear(Bytes bytes, TimePoint now) {
  if (LooksSigned(bytes)) bytes = WithoutSignature(bytes);  // the signature is not verified
  status_t status{};
  if (bytes.size() > kMaxMessageBytes || Examine(bytes, status) != nullptr || status.pid <= 0 ||
      status.waiting_ms < 0) {
    ++undecodable_;
    return;
  }
  WaitingRole role{.role = Safe(status.role),
                   .host = Safe(status.host),
                   .pid = status.pid,
                   .instance = status.instance,
                   .version = Safe(status.version),
                   .url = Safe(status.waiting_for),
                   .waiting_s = 1e-3 * static_cast<double>(status.waiting_ms),
                   .same_types = status.type_fingerprint == TypeFingerprint()};
  std::erase_if(entries_, [&](const Entry& entry) {
    return now - entry.heard > kGone || entry.role.instance == role.instance;
  });
  if (entries_.size() == kMax) {
    entries_.erase(std::ranges::min_element(entries_, {}, &Entry::heard));
  }
  entries_.push_back({.role = std::move(role), .heard = now});
}

std::vector<WaitingRole> WaitingRoles::Current(TimePoint now) const {
  std::vector<WaitingRole> current;
  for (const Entry& entry : entries_) {
    if (now - entry.heard <= kGone) current.push_back(entry.role);
  }
  std::ranges::sort(current, {}, [](const WaitingRole& one) {
    const auto place = std::ranges::find(kRoles, one.role, &RoleInfo::name) - kRoles.begin();
    return std::tuple(place, one.role, one.host, one.pid);
  });
  return current;
}

}  // namespace fogline::runtime
