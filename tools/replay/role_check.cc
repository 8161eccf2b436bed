#include "tools/replay/role_check.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "tools/processes/child.h"

namespace fogline::replay {

std::vector<RoleCheck> MakeRoleChecks(const log::RunLog& run, const log::DriverInputs& inputs) {
  std::vector<RoleCheck> roles;
  for (const RoleInfo& info : kRoles) {
    auto replay = MakeRoleReplay(info.role, run, inputs);
    if (replay != nullptr) roles.push_back({.role = info.role, .replay = std::move(replay)});
  }
  return roles;
}

void CheckRoles(log::RunLogReader& reader, std::vector<RoleCheck>& roles) {
  log::StepMessages before{};  // the bytes are valid as long as the reader exists
  std::int64_t step = 0;
  for (; const log::StepMessages* messages = reader.Next(); ++step) {
    for (RoleCheck& one : roles) {
      std::optional<Difference> difference = one.replay->Step(step, *messages, before);
      if (!difference) continue;
      ++one.steps_that_differ;
      if (!one.first) one.first = std::move(difference);
    }
    before = *messages;
  }
}

std::string Verification::Trouble() const {
  if (!failure) return broken;
  const Difference& first = failure->first;
  return fmt::format(
      "step {}: {} of {}: {} is {} in the log, and {} when it is computed again: was it altered on "
      "its way?",
      first.step, first.channel, NameOf(failure->role), first.field, first.a, first.b);
}

std::vector<runtime::OtherBuild> OtherBuildsIn(const log::RunLog& run) {
  std::vector<runtime::OtherBuild> others;
  if (!run.seal || !run.seal->whole) return others;
  const log_seal_t& says = run.seal->says;
  for (const RoleInfo& info : kRoles) {
    const auto place = std::ranges::find(says.role, info.name) - says.role.begin();
    if (place >= std::ssize(says.build_id)) continue;
    const runtime::BuildId build = says.build_id[static_cast<std::size_t>(place)];
    const runtime::BuildId ours = runtime::BuildIdOf(processes::ProgramOf(info.role));
    // If one process made the whole run, the seal has the build of that process's program for each
    // role. That process may have run the same program as this process. So the build of this
    // process's program counts as equal, too.
    if (build != runtime::kUnknownBuild && (build == ours || build == runtime::OwnBuildId()))
      continue;
    others.push_back({.role = info.role, .pid = 0, .host = "", .build = build, .ours = ours});
  }
  return others;
}

Verification VerifyRun(const std::filesystem::path& log, const log::RunLog& run,
                       const std::vector<runtime::OtherBuild>& others) {
  Verification verification;
  std::vector<RoleCheck> roles = MakeRoleChecks(run);
  std::erase_if(roles, [&](const RoleCheck& one) {
    std::string why;
    if (run.realtime) why = "a run in real time";
    const auto other = std::ranges::find(others, one.role, &runtime::OtherBuild::role);
    if (other != others.end()) {
      why = other->build == runtime::kUnknownBuild ? "of an unknown build" : "of another build";
    }
    if (!why.empty()) verification.left_out.push_back({.role = one.role, .why = why});
    return !why.empty();
  });
  for (const RoleCheck& one : roles) verification.roles.push_back(one.role);
  try {
    log::RunLogReader reader(log);
    CheckRoles(reader, roles);
  } catch (const InputError& error) {
    verification.broken = error.what();
  }
  for (RoleCheck& one : roles) {
    if (!one.first) continue;
    const bool earlier =
        !verification.failure || one.first->step < verification.failure->first.step;
    if (earlier) verification.failure = {.role = one.role, .first = std::move(*one.first)};
  }
  return verification;
}

}  // namespace fogline::replay
