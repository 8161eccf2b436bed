// Decides which process has which role of a run. A role can have a living instance, dead instances,
// and a second living instance that claims the role, too.
#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "services/runtime/coordination/run_coordinator.h"

namespace fogline::runtime {
namespace {

// The longest time between the sending and the arrival of a STATUS. If a STATUS of a replaced
// process comes more than this time after the replacement, the replaced process is alive.
constexpr Duration kOnItsWay = milliseconds(100);
// A process that has lost its role leaves the run within this time. In this time, five RUN messages
// say that another process has the role, and the process then leaves (Membership in
// node/membership.h).
constexpr Duration kLeaves = milliseconds(1000);

}  // namespace

bool RunCoordinator::IsExternal(Role role) const {
  return std::ranges::find(options_.external, role) != options_.external.end();
}

bool RunCoordinator::HasRival(Role role, TimePoint now) const {
  const Member& of = member(role);
  // The run waits for the rival to leave, but at most for kLeaves. After this time the rival is
  // refused. A silent rival counts as gone, because the runner does not see the end of a process
  // that was started elsewhere.
  return of.rival && !of.child && HeldAgainst(of.rival_since, now) <= kLeaves &&
         HeldAgainst(of.rival_heard, now) <= kLeaves;
}

std::int64_t RunCoordinator::HolderOf(Role role, TimePoint now) const {
  const Member& of = member(role);
  return of.status && HeldAgainst(of.heard, now) <= kSilent ? of.status->instance : 0;
}

bool RunCoordinator::Admit(Role role, const status_t& status, TimePoint now) {
  Member& member = members_[static_cast<std::size_t>(role)];
  const auto same = [&](const status_t& other) { return other.instance == status.instance; };
  if (const auto dead = std::ranges::find_if(member.dead, same); dead != member.dead.end()) {
    if (status.sequence > dead->sequence) OnUndead(role, status, now);
    return false;
  }
  const Process sender{.host = status.host, .pid = status.pid};
  if (std::ranges::find(member.ended, sender) != member.ended.end()) {
    return false;
  }
  // The runner knows the process that it has started. Every other process is refused, even if its
  // messages come first.
  if (member.child && *member.child != sender) {
    NoteRival(role, status, now);
    if (member.rival) NoteRefused(role, status);
    return false;
  }
  if (member.status && !same(*member.status)) return AdmitOther(role, status, now);
  if (status.state != status_t::LEFT) return true;
  if (member.status) {
    member.dead.push_back(status);
    member.status.reset();
    member.rival.reset();
    deaf_.Forget(role);
    announce_at_ = now;
  }
  return false;
}

void RunCoordinator::OnUndead(Role role, const status_t& status, TimePoint now) {
  Member& member = members_[static_cast<std::size_t>(role)];
  // Messages that the process sent before its end may come up to kOnItsWay late. Messages that come
  // after this time show that the process has not ended.
  if (!IsExternal(role) || !member.status || status.state == status_t::LEFT ||
      HeldAgainst(member.replaced_at, now) <= kOnItsWay) {
    return;
  }
  announce_at_ = now;  // RUN tells the process that another process has its role
  const bool speaks_on = member.undead && member.undead_instance == status.instance &&
                         HeldAgainst(member.undead_heard, now) <= kSilent;
  if (!speaks_on) member.undead = now;
  member.undead_instance = status.instance;
  member.undead_heard = now;
  if (HeldAgainst(*member.undead, now) > kLeaves) NoteRefused(role, status);
}

void RunCoordinator::NoteRival(Role role, const status_t& status, TimePoint now) {
  Member& member = members_[static_cast<std::size_t>(role)];
  if (status.state == status_t::LEFT || status.state == status_t::FAILED) {
    if (member.rival && member.rival->instance == status.instance) member.rival.reset();
    return;
  }
  const bool speaks_on = member.rival && member.rival->instance == status.instance &&
                         HeldAgainst(member.rival_heard, now) <= kSilent;
  if (!speaks_on) {
    member.rival = status;
    member.rival_since = now;
    announce_at_ = now;  // RUN tells the process that another process has its role
  }
  member.rival_heard = now;
}

void RunCoordinator::NoteRefused(Role role, const status_t& status) {
  members_[static_cast<std::size_t>(role)].refused = status;
  foreign_peers_.Hear(status);
}

std::string RunCoordinator::RefusedText() const {
  std::string text;
  for (const Member& member : members_) {
    if (!member.refused || !member.status) continue;
    text += fmt::format(
        "\n  two processes have the role {}: pid {} on {}, and pid {} on {}, which was "
        "refused",
        member.status->role, member.status->pid, member.status->host, member.refused->pid,
        member.refused->host);
  }
  return text;
}

bool RunCoordinator::AdmitOther(Role role, const status_t& status, TimePoint now) {
  Member& member = members_[static_cast<std::size_t>(role)];
  NoteRival(role, status, now);
  if (!member.rival || member.rival->instance != status.instance) return false;  // it has left
  // The first process keeps the role while its STATUS messages come.
  if (!IsExternal(role) || HeldAgainst(member.heard, now) <= kSilent) {
    if (HeldAgainst(member.rival_since, now) > kLeaves) NoteRefused(role, status);
    return false;
  }
  if (++member.replaced > options_.restarts) {
    Fail(
        fmt::format("{} was started again as pid {} on {} {}, after {} restarts "
                    "(--restarts)",
                    status.role, status.pid, status.host, Where(), options_.restarts));
    return false;
  }
  member.dead.push_back(std::move(*member.status));
  member.status.reset();
  member.rival.reset();
  member.undead.reset();
  deaf_.Forget(role);
  member.replaced_at = now;
  return true;
}

void RunCoordinator::MarkDead(Role role, std::int32_t pid, TimePoint now, const std::string& host) {
  Member& member = members_[static_cast<std::size_t>(role)];
  const Process& dead = member.ended.emplace_back(ProcessOn(host, pid));
  if (member.status && dead == Process{.host = member.status->host, .pid = member.status->pid}) {
    member.dead.push_back(std::move(*member.status));
    member.status.reset();
    deaf_.Forget(role);
  }
  member.rival.reset();
  progressed_ = now;  // a restart may follow, so the stall limit counts from now
}

bool RunCoordinator::AllPrepare(TimePoint now) const {
  return std::ranges::all_of(members_, [&](const Member& member) {
    return member.status &&
           (member.status->state != status_t::WAITING || HeldAgainst(member.heard, now) > kSilent);
  });
}

void RunCoordinator::Hinder(Role role, std::string why) {
  members_[static_cast<std::size_t>(role)].hindrance = std::move(why);
}

void RunCoordinator::Launched(Role role, std::int32_t pid, TimePoint now, const std::string& host,
                              Launch launch) {
  Member& member = members_[static_cast<std::size_t>(role)];
  std::erase(member.ended, ProcessOn(host, pid));
  member.child = ProcessOn(host, pid);
  signs_of_life_.Since(role, now);
  if (launch == Launch::kTriedAgain) return;
  member.hindrance.clear();
  progressed_ = now;
}

}  // namespace fogline::runtime
