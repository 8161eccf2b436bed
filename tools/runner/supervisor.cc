#include "tools/runner/supervisor.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include "tools/processes/child.h"

namespace fogline::runner {
namespace {

// Time in which the roles must leave after STOP.
constexpr Duration kLeaveLimit = milliseconds(1500);
constexpr Duration kLookEvery = milliseconds(20);
// Number and interval of the STOP messages for roles that run elsewhere. The supervisor repeats
// STOP, because it cannot see these roles leave. A network may lose many of the messages.
constexpr int kStopRepeats = 20;
constexpr Duration kStopEvery = milliseconds(10);
// A process counts as hanging if it has sent no STATUS for this long after its start.
constexpr Duration kStartLimit = milliseconds(5000);
// A silent process that still runs is killed only if the probability that all its messages were
// lost is below this value. With this value, on a network that loses many messages, a process is
// killed by mistake in one of a few thousand runs.
constexpr double kUnlikely = 1e-6;

/// "pid 4711", or "pid 4711 on lab2" for a process on another machine.
std::string PidText(const processes::RolePlace& place, pid_t pid) {
  return fmt::format("pid {}{}{}", pid, place.name().empty() ? "" : " on ", place.name());
}

}  // namespace

Supervisor::Supervisor(runtime::Bus& bus, runtime::RunCoordinator& coordinator, Options options)
    : bus_(bus), coordinator_(coordinator), options_(std::move(options)) {
  const TimePoint now = Clock::now();
  places_.push_back(&group_);
  if (options_.hosts != nullptr) {
    std::ranges::copy(options_.hosts->places(), std::back_inserter(places_));
  }
  for (const RoleInfo& info : kRoles) {
    if (std::ranges::find(options_.external, info.role) != options_.external.end()) continue;
    auto* place = options_.hosts == nullptr ? nullptr : options_.hosts->PlaceOf(info.role);
    if (place == nullptr) place = &group_;
    children_.push_back(
        {.role = info.role, .place = place, .policy = runtime::RestartPolicy(options_.restarts)});
    Start(children_.back(), now);
  }
}

void Supervisor::Start(Child& child, TimePoint now) {
  std::vector<std::string> arguments{"--lcm-url", options_.url, "--run-id",
                                     std::to_string(options_.run_id)};
  runtime::TrafficOptions traffic = options_.traffic;
  if (child.place != &group_) traffic.key_file.clear();  // that machine already has the key
  std::ranges::copy(runtime::ToArguments(traffic), std::back_inserter(arguments));
  if (child.role == Role::kRecorder) {
    arguments.insert(arguments.end(), {"--log", options_.log.string(), "--shared-log"});
    if (options_.wall_clock) arguments.emplace_back("--wall-clock");
    // Only a log of this run may be resumed. Before the first STATUS of the recorder, the file may
    // be an old log that is to be replaced.
    if (options_.resume || coordinator_.Met(Role::kRecorder)) arguments.emplace_back("--resume");
  }
  child.pid = child.place->StartRole(child.role, arguments);
  child.started = now;
  child.start_at.reset();
  child.activity.reset();
  child.killed_for.clear();
  child.deaf = false;
  using Launch = runtime::RunCoordinator::Launch;
  coordinator_.Launched(child.role, child.pid, now, child.place->host(),
                        child.ended_at_once > 0 ? Launch::kTriedAgain : Launch::kUsual);
}

std::vector<processes::RolePlace::Exit> Supervisor::Collect() {
  std::vector<processes::RolePlace::Exit> exits;
  for (processes::RolePlace* place : places_) {
    std::ranges::move(place->Collect(), std::back_inserter(exits));
  }
  return exits;
}

std::string Supervisor::Describe() const {
  std::string text;
  for (const processes::RolePlace* place : places_) {
    if (!place->empty()) text += (text.empty() ? "" : ", ") + place->Describe();
  }
  return text;
}

void Supervisor::Look(TimePoint now) {
  coordinator_.Attend(now);
  const std::vector<processes::RolePlace::Exit> exits = Collect();
  if (!exits.empty()) {
    // Handles the last messages of the processes first, and then the ends of the processes.
    bus_.Wait(kLookEvery);
    bus_.Drain();
  }
  for (const processes::RolePlace::Exit& exit : exits) OnExit(exit, now);
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
  } catch (const std::runtime_error& error) {  // a later call tries again
    child.start_at = now + child.policy.OnFailedStart();
    coordinator_.Hinder(child.role, error.what());
    return;
  }
  if (child.ended_at_once > 1) return;  // from the second early end on, no restart is reported
  options_.say(fmt::format("{} ({}) {}; started again as pid {} ({} of {})", NameOf(child.role),
                           PidText(*child.place, before), child.death, child.pid,
                           child.policy.restarts(), child.policy.limit()));
}

void Supervisor::OnExit(const processes::RolePlace::Exit& exit, TimePoint now) {
  const auto child = std::ranges::find(children_, exit.role, &Child::role);
  if (exit.pid != child->pid) return;  // a process whose start was reported too late
  const std::string& host = child->place->name();
  const std::string how = child->killed_for.empty() ? exit.how : child->killed_for;
  child->death = fmt::format("{} {}", how, coordinator_.Where());
  // A restarted process may end by itself before its first STATUS. An earlier process had the same
  // arguments and ran. So the cause is probably temporary, such as a network that is down, and the
  // process is started again.
  const auto& status = coordinator_.member(exit.role).status;
  const bool met = status && status->pid == exit.pid;
  if (!exit.killed && !met && child->policy.restarts() > 0) {
    ++child->ended_at_once;
    child->start_at = now + child->policy.OnFailedStart();
    coordinator_.Hinder(exit.role, exit.lines.empty() ? exit.how : exit.lines.back());
    return;
  }
  child->ended_at_once = 0;
  const auto wait = exit.killed ? child->policy.OnDeath(coordinator_.step()) : std::nullopt;
  if (wait) {
    coordinator_.MarkDead(exit.role, exit.pid, now, child->place->host());
    child->start_at = now + *wait;
    return;
  }
  // One line that names the process that has ended, then the last lines that it printed.
  std::string text =
      fmt::format("{} ({}) {}", NameOf(exit.role), PidText(*child->place, exit.pid), child->death);
  if (exit.killed && options_.restarts > 0) {
    text += fmt::format(", after {} restarts (--restarts)", child->policy.restarts());
  }
  const bool goes_on =
      options_.restarts > 0 && coordinator_.GoesOnWithout(exit.role) && !child->deaf;
  if (goes_on) text += "; the run goes on without it";
  for (const std::string& line : exit.lines) {
    text += fmt::format("\n  {}{}{}: {}", host, host.empty() ? "" : ": ", NameOf(exit.role), line);
  }
  if (!goes_on) return coordinator_.Fail(std::move(text));
  coordinator_.MarkDead(exit.role, exit.pid, now, child->place->host());
  child->gone = true;
  options_.say(text);
}

void Supervisor::KillIfItHangs(Child& child, TimePoint now) {
  const runtime::RunCoordinator::Member& member = coordinator_.member(child.role);
  const bool met = member.status && member.status->pid == child.pid;
  const Duration silent = coordinator_.HeldAgainst(met ? member.heard : child.started, now);
  const Duration limit = met ? options_.silence : kStartLimit;
  if (silent < limit / 2) child.activity.reset();
  if (!InSight(child) || silent < limit / 2 || !child.killed_for.empty()) return;
  if (!child.activity) child.activity = child.place->ActivityOf(child.pid);
  if (silent < limit) return;
  // A process that is active still runs. Perhaps it works, but its messages are lost.
  const bool runs = child.place->ActivityOf(child.pid) != child.activity;
  const std::string& host = child.place->name();
  if (runs && !met && !host.empty()) {
    return Hinder(child, fmt::format("it runs on {}, but none of its messages arrive; if the "
                                     "network carries no multicast: --relay",
                                     host));
  }
  const bool prepares = met && member.status->state == status_t::WAITING;
  if (runs && prepares && silent < kPrepareLimit) return;
  if (runs && coordinator_.ChanceOfLife(child.role, silent) > kUnlikely) return;
  Kill(child, fmt::format("was silent for {:.1f} s and was killed", Seconds(silent)));
}

bool Supervisor::InSight(Child& child) {
  const std::string why = child.place->WhyOutOfSight();
  if (!why.empty()) child.activity.reset();
  Hinder(child, why);
  return why.empty();
}

void Supervisor::Hinder(Child& child, const std::string& why) {
  if (why.empty() && !child.hindered) return;
  child.hindered = !why.empty();
  coordinator_.Hinder(child.role, why);
}

void Supervisor::KillIfItIsDeaf(Child& child) {
  const auto deaf = coordinator_.Deaf(child.role);
  if (!deaf || !child.killed_for.empty()) return;
  child.deaf = true;
  Kill(child, Text(*deaf) + ", and was killed");
}

void Supervisor::Kill(Child& child, std::string why) {
  child.killed_for = std::move(why);
  child.place->Kill(child.pid);
}

void Supervisor::NameTheDeaf() {
  for (const RoleInfo& info : kRoles) {
    const auto deaf = coordinator_.Deaf(info.role);
    if (!deaf) {
      deaf_.erase(info.role);
      continue;
    }
    const bool ours = std::ranges::find(children_, info.role, &Child::role) != children_.end();
    if ((ours && options_.restarts > 0) || !deaf_.insert(info.role).second) continue;
    const auto& status = coordinator_.member(info.role).status;
    if (!status) continue;
    options_.say(fmt::format("warning: {} (pid {} on {}) is deaf: it {}", info.name, status->pid,
                             status->host, Text(*deaf)));
  }
}

void Supervisor::End() {
  const TimePoint began = Clock::now();
  int said = 0;
  const auto runs = [](const processes::RolePlace* place) { return !place->empty(); };
  while ((std::ranges::any_of(places_, runs) && Clock::now() - began < kLeaveLimit) ||
         (said < kStopRepeats && !options_.external.empty())) {
    coordinator_.Stop();
    ++said;
    const TimePoint pause = Clock::now() + kStopEvery;
    // Handles messages until the time `pause`. If messages arrive faster than they are handled, a
    // loop until no message is left would never end.
    while (Clock::now() < pause) bus_.Wait(pause - Clock::now());
    Collect();
  }
  bus_.Drain();  // the last messages of the processes
}

std::vector<Restarts> Supervisor::restarts() const {
  std::vector<Restarts> restarts;
  for (const RoleInfo& info : kRoles) {
    const auto child = std::ranges::find(children_, info.role, &Child::role);
    const runtime::RunCoordinator::Member& member = coordinator_.member(info.role);
    if (child != children_.end()) {
      if (child->policy.restarts() == 0) continue;
      restarts.push_back({.role = std::string(info.name),
                          .count = child->policy.restarts(),
                          .last = child->death});
    } else {
      // If a new process of the role came shortly before the end of the run, the previous process
      // may not have been silent long enough to count as ended. `replaced` does not contain this
      // restart, so it is added here.
      const bool late = member.rival && member.status && member.heard < member.rival_since;
      const int elsewhere = member.replaced + (late ? 1 : 0);
      if (elsewhere == 0) continue;
      const status_t& dead = late ? *member.status : member.dead.back();
      restarts.push_back({.role = std::string(info.name),
                          .count = elsewhere,
                          .last = fmt::format("pid {} on {} fell silent at step {}", dead.pid,
                                              dead.host, dead.header.step)});
    }
  }
  return restarts;
}

}  // namespace fogline::runner
