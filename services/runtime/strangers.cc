#include "services/runtime/strangers.h"

#include <algorithm>

#include <fmt/core.h>

#include "services/graph.h"

namespace fogline {
namespace {

// Of a host name (POSIX HOST_NAME_MAX on Linux).
constexpr std::size_t kMaxHost = 64;

/// A name from the network, as it may be printed.
std::string Printable(std::string name) {
  name.resize(std::min(name.size(), kMaxHost));
  std::ranges::replace_if(
      name, [](char c) { return c <= ' ' || c > '~'; }, '?');
  return name;
}

}  // namespace

std::string Describe(const Stranger& stranger) {
  return fmt::format("{} (pid {} on {}) of run {}", stranger.role, stranger.pid, stranger.host,
                     stranger.run_id);
}

void Strangers::Hear(const status_t& status) {
  const bool known = std::ranges::any_of(known_, [&status](const Stranger& stranger) {
    return stranger.run_id == status.header.run_id && stranger.pid == status.pid &&
           stranger.role == status.role && stranger.host == Printable(status.host);
  });
  if (known || std::ranges::find(kRoles, status.role, &RoleInfo::name) == kRoles.end()) return;
  if (known_.size() == kMax) {
    more_ = true;
    return;
  }
  known_.push_back({.role = status.role,
                    .pid = status.pid,
                    .host = Printable(status.host),
                    .run_id = status.header.run_id});
}

std::string Strangers::Text() const {
  std::string text;
  for (const Stranger& stranger : known_) {
    text += fmt::format("{}ignored: {}", text.empty() ? "" : "\n", Describe(stranger));
  }
  if (more_) text += "\nignored: more processes of other runs";
  return text;
}

}  // namespace fogline
