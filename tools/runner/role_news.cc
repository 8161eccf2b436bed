#include "tools/runner/role_news.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "common/process/priority.h"
#include "common/process/this_process.h"
#include "services/runtime/node/runner_watch.h"

namespace fogline::runner {
namespace {

// Interval at which the runner checks whether awaited roles belong to other runs.
constexpr Duration kLookForExternal = milliseconds(100);
// A role asks for its priority before it computes its first step. So the runner waits until all
// roles compute steps, and then examines their priorities. It waits no longer than this time.
constexpr Duration kPriorityIsKnown = milliseconds(1000);

using Phase = runtime::RunCoordinator::Phase;

std::string ProcessOf(const status_t& status) {
  return fmt::format("{} (pid {} on {})", status.role, status.pid, status.host);
}

}  // namespace

std::vector<status_t> LastWords(const runtime::RunCoordinator& coordinator, Role role) {
  const runtime::RunCoordinator::Member& member = coordinator.member(role);
  std::vector<status_t> words = member.dead;
  if (member.status) words.push_back(*member.status);
  return words;
}

std::vector<runtime::OtherBuild> OtherBuilds(const runtime::RunCoordinator& coordinator) {
  std::vector<runtime::OtherBuild> others;
  for (const RoleInfo& info : kRoles) {
    for (const status_t& status : LastWords(coordinator, info.role)) {
      auto other = runtime::OtherBuildOf(info.role, status, coordinator.builds());
      if (other) others.push_back(std::move(*other));
    }
  }
  return others;
}

void BusyElsewhere::Look(const runtime::RunCoordinator& coordinator, TimePoint now) {
  if (now < look_at_) return;
  look_at_ = now + kLookForExternal;
  const std::vector<Role> awaited = coordinator.Awaited(now);
  if (awaited.empty()) return;
  for (const runtime::ForeignPeer& peer : coordinator.foreign_peers().known()) {
    const std::string description = Describe(peer);
    const bool is_awaited =
        std::ranges::any_of(awaited, [&peer](Role role) { return NameOf(role) == peer.role; });
    if (!is_awaited || peer.run_id == run_id_ || !told_.insert(description).second) continue;
    say_(
        fmt::format("{} is not free: it joins this run when that run is over, or when its runner "
                    "has been silent for {:g} s",
                    description, Seconds(runtime::RunnerWatch::kSilent)));
  }
}

void Warnings::LookAtTheClock() {
  const Duration away = coordinator_.TakeLongestPause();
  if (away == Duration::zero()) return;
  Say(fmt::format("the runner was held up for {:.1f} s {}",
                  std::chrono::duration<double>(away).count(), coordinator_.Where()));
}

void Warnings::LookAtTheRoles() {
  if (!compared_ && coordinator_.phase() == Phase::kRunning) {
    compared_ = true;
    for (const runtime::OtherBuild& other : OtherBuilds(coordinator_)) Say(other.Text());
  }
  if (key_trouble_.empty()) {
    key_trouble_ = coordinator_.KeyTrouble();
    if (!key_trouble_.empty()) Say(key_trouble_);
  }
  NameTheRefused();
}

void Warnings::NameTheRefused() {
  for (const RoleInfo& info : kRoles) {
    const runtime::RunCoordinator::Member& member = coordinator_.member(info.role);
    if (!member.refused || !member.status || !refused_.insert(member.refused->instance).second) {
      continue;
    }
    Say(fmt::format("{} is refused: the {} of this run is pid {} on {}", ProcessOf(*member.refused),
                    info.name, member.status->pid, member.status->host));
  }
}

bool PriorityWatch::Look(const runtime::RunCoordinator& coordinator, TimePoint now) {
  if (done_ || coordinator.phase() != Phase::kRunning) return false;
  if (since_ == TimePoint{}) since_ = now;
  const std::string host = HostName();
  log::RealtimePriority found;
  bool all_run = true;
  for (const RoleInfo& info : kRoles) {
    const auto& status = coordinator.member(info.role).status;
    all_run = all_run && status && status->state == status_t::RUNNING;
    auto& list = !status || status->host != host        ? found.unknown
                 : ThreadsBeforeOthers(status->pid) > 0 ? found.granted
                                                        : found.refused;
    list.emplace_back(info.name);
  }
  if (!all_run && coordinator.HeldAgainst(since_, now) < kPriorityIsKnown) return false;
  found_ = std::move(found);
  return done_ = true;
}

std::string PriorityWatch::Text() const {
  const log::RealtimePriority& found = *found_;
  std::string text;
  if (!found.refused.empty()) {
    text = fmt::format(
        "warning: without real-time priority: {}. On a busy machine steps begin late; `fogline "
        "doctor` says how to grant it",
        fmt::join(found.refused, ", "));
  } else if (!found.granted.empty()) {
    text = fmt::format("with real-time priority: {}", fmt::join(found.granted, ", "));
  }
  if (found.unknown.empty()) return text;
  return fmt::format(
      "{}{}on other machines, where each role says itself whether it has real-time "
      "priority: {}",
      text, text.empty() ? "" : "; ", fmt::join(found.unknown, ", "));
}

}  // namespace fogline::runner
