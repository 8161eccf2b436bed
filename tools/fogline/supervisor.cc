#include "tools/fogline/supervisor.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <utility>

#include <fmt/core.h>

#include "tools/fogline/child.h"

namespace fogline {
namespace {

// How long the roles may take to leave when they are told to.
constexpr Duration kLeaveLimit = milliseconds(1500);
constexpr Duration kLookEvery = milliseconds(20);
// STOP is said this often to roles that run elsewhere: their leaving cannot be seen.
constexpr int kStopRepeats = 5;
// A process that is not heard of for so long after its start hangs.
constexpr Duration kStartLimit = milliseconds(5000);
// A process that runs and is not heard counts as alive unless this is less likely: so few are
// killed in vain that it happens in one of some thousand runs on a network that loses a lot.
constexpr double kUnlikely = 1e-6;

/// How often a process has begun to wait, or was made to; nothing if it cannot be known. Whoever
/// lives does so many times a second.
std::optional<std::int64_t> ActivityOf(pid_t pid) {
  std::ifstream status(fmt::format("/proc/{}/status", pid));
  std::int64_t sum = 0;
  bool known = false;
  for (std::string key; status >> key;) {
    if (!key.ends_with("voluntary_ctxt_switches:")) continue;
    std::int64_t count = 0;
    known = static_cast<bool>(status >> count);
    sum += count;
  }
  return known ? std::optional(sum) : std::nullopt;
}

}  // namespace

Supervisor::Supervisor(Bus& bus, Conductor& conductor, Options options)
    : bus_(bus), conductor_(conductor), options_(std::move(options)) {
  const TimePoint now = Clock::now();
  for (const RoleInfo& info : kRoles) {
    if (std::ranges::find(options_.external, info.role) != options_.external.end()) continue;
    children_.push_back({.role = info.role, .policy = RestartPolicy(options_.restarts)});
    Start(children_.back(), now);
  }
}

void Supervisor::Start(Child& child, TimePoint now) {
  std::vector<std::string> arguments{"--lcm-url", options_.url, "--run-id",
                                     std::to_string(options_.run_id)};
  arguments.insert(arguments.end(), options_.arguments.begin(), options_.arguments.end());
  if (child.role == Role::kRecorder) {
    arguments.insert(arguments.end(), {"--log", options_.log.string(), "--shared-log"});
    // Only if it is the log of this run: before that it may be an old one that is to be replaced.
    if (options_.resume || conductor_.Met(Role::kRecorder)) arguments.emplace_back("--resume");
  }
  child.pid = group_.Start(child.role, ProgramOf(child.role), arguments);
  child.started = now;
  child.start_at.reset();
  child.activity.reset();
  child.killed_for.clear();
  child.deaf = false;
  conductor_.Launched(child.role, child.pid, now);
}

void Supervisor::Look(TimePoint now) {
  conductor_.Attend(now);
  const std::vector<ProcessGroup::Exit> exits = group_.Collect();
  if (!exits.empty()) {
    // What they said last comes before their end.
    bus_.Wait(kLookEvery);
    bus_.Drain();
  }
  for (const ProcessGroup::Exit& exit : exits) OnExit(exit, now);
  for (Child& child : children_) {
    if (child.start_at && now >= *child.start_at) {
      StartAgain(child, now);
    } else if (!child.start_at && !child.gone && options_.restarts > 0) {
      KillIfItHangs(child, now);
      KillIfItIsDeaf(child);
    }
  }
  NameTheDeaf();
}

void Supervisor::StartAgain(Child& child, TimePoint now) {
  const pid_t before = child.pid;
  try {
    Start(child, now);
  } catch (const std::runtime_error& error) {  // for now, perhaps: the stall timeout decides
    child.start_at = now + child.policy.OnFailedStart();
    conductor_.Hinder(child.role, error.what());
    return;
  }
  options_.say(fmt::format("{} (pid {}) {}; started again as pid {} ({} of {})", NameOf(child.role),
                           before, child.death, child.pid, child.policy.restarts(),
                           child.policy.limit()));
}

void Supervisor::OnExit(const ProcessGroup::Exit& exit, TimePoint now) {
  const auto child = std::ranges::find(children_, exit.role, &Child::role);
  const std::string how = child->killed_for.empty() ? exit.how : child->killed_for;
  child->death = fmt::format("{} {}", how, conductor_.Where());
  const auto wait = exit.killed ? child->policy.OnDeath(conductor_.step()) : std::nullopt;
  if (wait) {
    conductor_.Bury(exit.role, exit.pid, now);
    child->start_at = now + *wait;
    return;
  }
  // One line that says who died, then what it had to say.
  std::string text = fmt::format("{} (pid {}) {}", NameOf(exit.role), exit.pid, child->death);
  if (exit.killed && options_.restarts > 0) {
    text += fmt::format(", after {} restarts (--restarts)", child->policy.restarts());
  }
  const bool goes_on = options_.restarts > 0 && conductor_.GoesOnWithout(exit.role) && !child->deaf;
  if (goes_on) text += "; the run goes on without it";
  for (const std::string& line : exit.lines) {
    text += fmt::format("\n  {}: {}", NameOf(exit.role), line);
  }
  if (!goes_on) return conductor_.Fail(std::move(text));
  conductor_.Bury(exit.role, exit.pid, now);
  child->gone = true;
  options_.say(text);
}

void Supervisor::KillIfItHangs(Child& child, TimePoint now) {
  const Conductor::Member& member = conductor_.member(child.role);
  const bool met = member.status && member.status->pid == child.pid;
  const Duration silent = conductor_.HeldAgainst(met ? member.heard : child.started, now);
  const Duration limit = met ? options_.silence : kStartLimit;
  if (silent < limit / 2) child.activity.reset();
  if (silent < limit / 2 || !child.killed_for.empty()) return;
  if (!child.activity) child.activity = ActivityOf(child.pid);
  if (silent < limit) return;
  // One that runs may be one that is not heard.
  if (ActivityOf(child.pid) != child.activity &&
      conductor_.ChanceOfLife(child.role, silent) > kUnlikely) {
    return;
  }
  Kill(child, fmt::format("was silent for {:.1f} s and was killed", Seconds(silent)));
}

void Supervisor::KillIfItIsDeaf(Child& child) {
  const auto deaf = conductor_.Deaf(child.role);
  if (!deaf || !child.killed_for.empty()) return;
  child.deaf = true;
  Kill(child, Text(*deaf) + ", and was killed");
}

void Supervisor::Kill(Child& child, std::string why) {
  child.killed_for = std::move(why);
  kill(child.pid, SIGKILL);
}

void Supervisor::NameTheDeaf() {
  for (const RoleInfo& info : kRoles) {
    const auto deaf = conductor_.Deaf(info.role);
    if (!deaf) {
      deaf_.erase(info.role);
      continue;
    }
    const bool ours = std::ranges::find(children_, info.role, &Child::role) != children_.end();
    if ((ours && options_.restarts > 0) || !deaf_.insert(info.role).second) continue;
    const auto& status = conductor_.member(info.role).status;
    if (!status) continue;
    options_.say(fmt::format("warning: {} (pid {} on {}) is deaf: it {}", info.name, status->pid,
                             status->host, Text(*deaf)));
  }
}

void Supervisor::End() {
  const TimePoint began = Clock::now();
  int said = 0;
  while ((!group_.empty() && Clock::now() - began < kLeaveLimit) ||
         (said < kStopRepeats && !options_.external.empty())) {
    conductor_.Stop();
    ++said;
    const TimePoint pause = Clock::now() + kLookEvery;
    // Until then, however many messages there are: a flood of them must not hold up the end.
    while (Clock::now() < pause) bus_.Wait(pause - Clock::now());
    group_.Collect();
  }
  bus_.Drain();  // what the last of them has said
}

std::vector<Restarts> Supervisor::restarts() const {
  std::vector<Restarts> restarts;
  for (const RoleInfo& info : kRoles) {
    const auto child = std::ranges::find(children_, info.role, &Child::role);
    const Conductor::Member& member = conductor_.member(info.role);
    if (child != children_.end()) {
      if (child->policy.restarts() == 0) continue;
      restarts.push_back({.role = std::string(info.name),
                          .count = child->policy.restarts(),
                          .last = child->death});
    } else if (const int elsewhere = member.replaced + (member.rival ? 1 : 0); elsewhere > 0) {
      // The last one may have come too late in the run to be sure that the one before it is dead.
      const status_t& dead = member.rival ? *member.status : member.dead.back();
      restarts.push_back({.role = std::string(info.name),
                          .count = elsewhere,
                          .last = fmt::format("pid {} on {} fell silent at step {}", dead.pid,
                                              dead.host, dead.header.step)});
    }
  }
  return restarts;
}

}  // namespace fogline
