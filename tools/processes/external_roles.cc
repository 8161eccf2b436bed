#include "tools/processes/external_roles.h"

#include <chrono>

#include <fmt/core.h>

namespace fogline::processes {

std::string ExternalRoles::Limit() const {
  if (limit_ == Duration::zero()) return "for ever";
  return fmt::format("{:g} s", std::chrono::duration<double>(limit_).count());
}

std::string ExternalRoles::Command(Role role) const {
  const std::string key = key_file_.empty() ? "" : fmt::format(" --key '{}'", key_file_);
  return fmt::format("fogline-{} --lcm-url '{}'{}", NameOf(role), url_, key);
}

std::string ExternalRoles::Text(const std::vector<Role>& roles) const {
  std::string text;
  for (const Role role : roles) {
    text += fmt::format("{}waiting for the {} ({}): start it with: {}", text.empty() ? "" : "\n",
                        NameOf(role), Limit(), Command(role));
  }
  return text;
}

void ExternalRoles::Check(runtime::RunCoordinator& coordinator, TimePoint now) const {
  if (limit_ == Duration::zero() || coordinator.phase() != runtime::RunCoordinator::Phase::kJoining)
    return;
  if (coordinator.HeldAgainst(began_, now) <= limit_) return;
  std::string names;
  std::string commands;
  for (const Role role : coordinator.Awaited(now)) {
    names += fmt::format("{} the {}", names.empty() ? "" : ",", NameOf(role));
    commands += fmt::format("{} {}", commands.empty() ? "" : " and", Command(role));
  }
  if (names.empty()) return;
  coordinator.Fail(fmt::format("waited {} for{} in vain; start with:{} (--wait 0 waits for ever)",
                               Limit(), names, commands));
}

}  // namespace fogline::processes
