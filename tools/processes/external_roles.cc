#include "tools/processes/external_roles.h"

#include <algorithm>
#include <chrono>

#include <fmt/core.h>

namespace fogline::processes {
namespace {

/// Names of the roles, such as "the acc, the driver".
std::string TheRoles(const std::vector<Role>& roles) {
  std::string names;
  for (const Role role : roles) {
    names += fmt::format("{}the {}", names.empty() ? "" : ", ", NameOf(role));
  }
  return names;
}

}  // namespace

std::string ExternalRoles::Limit() const {
  if (limit_ == Duration::zero()) return "for ever";
  return fmt::format("{:g} s", std::chrono::duration<double>(limit_).count());
}

std::string ExternalRoles::Command(std::string_view role) const {
  const std::string key = key_file_.empty() ? "" : fmt::format(" --key '{}'", key_file_);
  return fmt::format("fogline-{} --lcm-url '{}'{}", role, url_, key);
}

std::string ExternalRoles::Text(const std::vector<Role>& roles) const {
  if (roles.empty()) return "";
  const bool one = roles.size() == 1;
  return fmt::format("waiting for {} ({}): start {} with: {}", TheRoles(roles), Limit(),
                     one ? "it" : "each", Command(one ? NameOf(roles.front()) : "ROLE"));
}

std::string ExternalRoles::News(const std::vector<Role>& roles,
                                const runtime::RunCoordinator& coordinator, TimePoint now) {
  if (coordinator.phase() != runtime::RunCoordinator::Phase::kJoining) return "";
  const std::vector<Role> awaited = coordinator.Awaited(now);
  std::string news;
  for (const RoleInfo& info : kRoles) {
    const auto& status = coordinator.member(info.role).status;
    const bool there = std::ranges::find(roles, info.role) != roles.end() &&
                       std::ranges::find(awaited, info.role) == awaited.end();
    if (there == come_.contains(info.role)) continue;
    if (there) {
      come_.insert(info.role);
      news += fmt::format("{}the {} has come (pid {} on {})", news.empty() ? "" : ", ", info.name,
                          status->pid, status->host);
    } else {
      come_.erase(info.role);
      news += fmt::format("{}the {} has gone", news.empty() ? "" : ", ", info.name);
    }
  }
  if (news.empty() || awaited.empty()) return news;
  return fmt::format("{}; missing: {}", news, TheRoles(awaited));
}

void ExternalRoles::Check(runtime::RunCoordinator& coordinator, TimePoint now) const {
  if (limit_ == Duration::zero() || coordinator.phase() != runtime::RunCoordinator::Phase::kJoining)
    return;
  if (coordinator.HeldAgainst(began_, now) <= limit_) return;
  const std::vector<Role> awaited = coordinator.Awaited(now);
  if (awaited.empty()) return;
  std::string commands;
  for (const Role role : awaited) {
    commands += fmt::format("{} {}", commands.empty() ? "" : " and", Command(role));
  }
  coordinator.Fail(fmt::format("waited {} for {} in vain; start with:{} (--wait 0 waits for ever)",
                               Limit(), TheRoles(awaited), commands));
}

}  // namespace fogline::processes
