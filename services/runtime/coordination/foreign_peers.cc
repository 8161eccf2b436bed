#include "services/runtime/coordination/foreign_peers.h"

#include <algorithm>
#include <functional>

#include <fmt/core.h>

#include "common/text.h"
#include "services/graph.h"

namespace fogline::runtime {
namespace {

// The longest host name (POSIX HOST_NAME_MAX on Linux).
constexpr std::size_t kMaxHost = 64;

/// A host's name from the network, made safe to print.
std::string PrintableHost(const std::string& name) { return Printable(name.substr(0, kMaxHost)); }

}  // namespace

std::string Describe(const ForeignPeer& peer) {
  return fmt::format("{} (pid {} on {}) of run {}", peer.role, peer.pid, peer.host, peer.run_id);
}

void ForeignPeers::Hear(const status_t& status) {
  if (std::ranges::find(kRoles, status.role, &RoleInfo::name) == kRoles.end()) return;
  const auto known = std::ranges::find_if(watched_, [&status](const Watched& one) {
    return one.peer.run_id == status.header.run_id && one.peer.pid == status.pid &&
           one.peer.role == status.role && one.peer.host == PrintableHost(status.host);
  });
  if (known != watched_.end()) {
    ++known->heard;
    return;
  }
  if (watched_.size() == kMaxWatched) {
    // Forgets the oldest of the processes with the fewest messages.
    watched_.erase(std::ranges::min_element(watched_, {}, &Watched::heard));
    forgotten_ = true;
  }
  watched_.push_back({.peer = {.role = status.role,
                               .pid = status.pid,
                               .host = PrintableHost(status.host),
                               .run_id = status.header.run_id},
                      .heard = 1});
}

std::vector<ForeignPeer> ForeignPeers::known() const {
  std::vector<const Watched*> told;
  for (const Watched& one : watched_) told.push_back(&one);
  std::ranges::stable_sort(told, std::greater{}, &Watched::heard);
  told.resize(std::min(told.size(), kMax));
  std::ranges::sort(told);  // by address, which is the order in watched_
  std::vector<ForeignPeer> known;
  for (const Watched* one : told) known.push_back(one->peer);
  return known;
}

std::string ForeignPeers::Text() const {
  std::string text;
  for (const ForeignPeer& peer : known()) {
    text += fmt::format("{}ignored: {}", text.empty() ? "" : "\n", Describe(peer));
  }
  if (watched_.size() > kMax || forgotten_) text += "\nignored: more processes of other runs";
  return text;
}

}  // namespace fogline::runtime
