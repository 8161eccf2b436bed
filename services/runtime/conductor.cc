#include "services/runtime/conductor.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "scenario/wording.h"
#include "services/runtime/possible_status.h"
#include "services/runtime/this_process.h"

namespace fogline {
namespace {

constexpr Duration kAnnounceEvery = milliseconds(50);
// While the run goes on: a sign of life, which roles that were started elsewhere wait for.
constexpr Duration kRepeatEvery = milliseconds(200);
// Requests for the whole scenario that come together are answered together.
constexpr Duration kPartsEvery = milliseconds(10);
// A role without a STATUS for this long (five heartbeats) counts as silent.
constexpr Duration kSilent = milliseconds(1000);
// If the runner itself has not looked for so long (the machine was suspended, its disk held it up,
// Ctrl-Z), what it has not heard in that time means nothing.
constexpr Duration kAway = milliseconds(500);
// A STATUS may be so long on its way; later than that its sender is alive.
constexpr Duration kOnItsWay = milliseconds(100);

std::optional<Role> RoleNamed(std::string_view name) {
  for (const RoleInfo& info : kRoles) {
    if (info.name == name) return info.role;
  }
  return std::nullopt;
}

}  // namespace

Conductor::Conductor(Bus& bus, ConductorOptions options)
    : bus_(bus),
      options_(std::move(options)),
      parts_(SplitScenario(options_.scenario_text)),
      hash_(HashOf(options_.scenario_text)),
      host_(HostName()),
      began_(Clock::now()),
      looked_(began_),
      sequence_(options_.sequence),
      progress_(options_.progress) {
  bus_.Subscribe(ChannelOf<status_t>().name, [this](Arrival& arrival) {
    if (const RefusalCounter wrong = arrival.Wrong<status_t>()) return Refuse(wrong);
    OnStatus(*arrival.As<status_t>());
  });
  bus_.Subscribe(ChannelOf<resend_t>().name, [this](Bytes bytes) { OnResend(bytes); },
                 {.offset = kHeaderEnd, .texts = {EncodedText(ChannelOf<run_t>().name)}});
}

void Conductor::Attend(TimePoint now) {
  const Duration away = now - looked_;
  if (away > kAway) {
    pauses_.push_back({.from = looked_, .to = now});
    away_ = std::max(away_, away);
  }
  looked_ = now;
}

Duration Conductor::HeldAgainst(TimePoint since, TimePoint now) const {
  Duration held = now - since;
  for (auto pause = pauses_.rbegin(); pause != pauses_.rend() && pause->to > since; ++pause) {
    held -= pause->to - std::max(pause->from, since);
  }
  return held;
}

TimePoint Conductor::Poll(TimePoint now) {
  Attend(now);
  const Bus::Unverified unverified = bus_.TakeUnverified();
  own_.not_signed += unverified.not_signed;
  own_.badly_signed += unverified.badly_signed;
  const bool ready = AllReady(now);
  if (ready != ready_) announce_at_ = now;
  ready_ = ready;
  if (phase_ == Phase::kJoining && ready) {
    phase_ = Phase::kRunning;
    progressed_ = now;
  }
  // A recorder that reads a long log says how far it is.
  if (phase_ == Phase::kJoining && options_.join_limit > Duration::zero() &&
      HeldAgainst(std::max(began_, progressed_), now) > options_.join_limit) {
    Fail(fmt::format("not ready after {:.1f} s: {}", Seconds(options_.join_limit), NotReady()));
  }
  if (phase_ == Phase::kRunning && HeldAgainst(progressed_, now) > options_.stall_limit) {
    Fail(Culprit(now));
  }
  if (phase_ == Phase::kJoining || phase_ == Phase::kRunning) AnnounceWhenDue(now);
  return std::min(announce_at_, now + kAnnounceEvery);
}

void Conductor::AnnounceWhenDue(TimePoint now) {
  if (now < announce_at_) return;
  // PREPARE until every role is ready, the first time and whenever one has been started again; GO
  // until the world goes.
  const auto& world = member(Role::kWorld).status;
  const bool going = ready_ && world && world->state != status_t::READY;
  Announce(0);
  announce_at_ = now + (going ? kRepeatEvery : kAnnounceEvery);
}

bool Conductor::IsExternal(Role role) const {
  return std::ranges::find(options_.external, role) != options_.external.end();
}

bool Conductor::AllReady(TimePoint now) const {
  return std::ranges::none_of(kRoles, [&](const RoleInfo& info) {
    return Lacks(info.role, now) || member(info.role).rival;
  });
}

bool Conductor::Lacks(Role role, TimePoint now) const {
  const Member& of = member(role);
  const bool lost =
      phase_ == Phase::kRunning && IsExternal(role) && HeldAgainst(of.heard, now) > kSilent;
  return !of.status || of.status->state == status_t::WAITING || lost;
}

std::vector<Role> Conductor::Awaited(TimePoint now) const {
  std::vector<Role> awaited;
  for (const RoleInfo& info : kRoles) {
    if (IsExternal(info.role) && Lacks(info.role, now)) awaited.push_back(info.role);
  }
  return awaited;
}

std::string Conductor::NotReady() const {
  std::string names;
  for (const RoleInfo& info : kRoles) {
    const auto& status = member(info.role).status;
    if (status && status->state != status_t::WAITING) continue;
    names +=
        fmt::format("{}{}{}", names.empty() ? "" : ", ", info.name, status ? "" : " (never heard)");
  }
  return names;
}

std::int64_t Conductor::Total(std::int64_t status_t::*counter) const {
  std::int64_t total = 0;
  for (const Member& member : members_) {
    if (member.status) total += (*member.status).*counter;
    for (const status_t& status : member.dead) total += status.*counter;
  }
  return total;
}

Refusals Conductor::Refused() const {
  Refusals refused{};
  std::ranges::transform(kRefusals, refused.begin(), [this](const RefusalKind& kind) {
    return Total(kind.counter) + own_.*kind.counter;
  });
  return refused;
}

std::string Conductor::KeyTrouble() const {
  return SignatureTrouble({.not_signed = Total(&status_t::not_signed) + own_.not_signed,
                           .badly_signed = Total(&status_t::badly_signed) + own_.badly_signed,
                           .no_key = bus_.unverified().no_key});
}

void Conductor::Stop() { Announce(run_t::STOP, 0); }

void Conductor::Fail(std::string error) {
  if (phase_ == Phase::kFailed || phase_ == Phase::kDone) return;
  phase_ = Phase::kFailed;
  error_ = std::move(error);
  if (const std::string trouble = KeyTrouble(); !trouble.empty()) error_ += "\n  " + trouble;
}

void Conductor::OnStatus(const status_t& heard) {
  if (heard.header.run_id != options_.run_id) {
    strangers_.Hear(heard);
    return Refuse(&status_t::foreign);
  }
  if (!IsPossible(heard) || heard.header.step > options_.steps)
    return Refuse(&status_t::out_of_window);
  status_t status = heard;  // with texts as they may be printed
  status.host = EscapeControls(heard.host);
  status.error = EscapeControls(heard.error);
  const auto role = RoleNamed(status.role);
  if (!role) return Refuse(&status_t::malformed);
  if (phase_ != Phase::kJoining && phase_ != Phase::kRunning) return;
  const TimePoint now = Clock::now();
  Attend(now);
  if (!Admit(*role, status, now)) return;
  Member& member = members_[static_cast<std::size_t>(*role)];
  if (member.status && status.sequence <= member.status->sequence) return;  // overtaken on its way
  const bool joined = status.state == status_t::READY || status.state == status_t::RUNNING;
  if (joined && status.scenario_hash != hash_) {
    return Fail(fmt::format("{} (pid {} on {}) has another scenario", status.role, status.pid,
                            status.host));
  }
  if (joined && status.type_fingerprint != TypeFingerprint()) {
    return Fail(fmt::format("{} (pid {} on {}) was built with other message types", status.role,
                            status.pid, status.host));
  }
  // A role that catches up makes progress, too. It starts below what its predecessor had done.
  if (member.status && status.header.step > member.status->header.step) progressed_ = now;
  progress_ = std::max(progress_, status.header.step);
  member.status = status;
  member.heard = now;
  const bool decides = *role == Role::kWorld || *role == Role::kArbitrator;
  if (const auto cars = static_cast<std::int8_t>(minimal_risk_ | status.minimal_risk);
      decides && cars != minimal_risk_) {
    minimal_risk_ = cars;
    announce_at_ = now;
  }
  if (on_status_) on_status_(status);
  if (member.status->state == status_t::FAILED) return OnFailure(*role, status);
  if (*role == Role::kWorld && member.status->state == status_t::DONE) phase_ = Phase::kDone;
}

void Conductor::OnFailure(Role role, const status_t& status) {
  // In real time the cars are under way: what fails is lost, and the others know what to do then.
  if (GoesOnWithout(role)) return;
  Fail(fmt::format("{}: {}", status.role, status.error));
}

bool Conductor::Admit(Role role, const status_t& status, TimePoint now) {
  Member& member = members_[static_cast<std::size_t>(role)];
  const auto same = [&](const status_t& other) { return other.instance == status.instance; };
  if (const auto dead = std::ranges::find_if(member.dead, same); dead != member.dead.end()) {
    // What it said before its death may come late. If it speaks on, it was not dead.
    if (IsExternal(role) && member.status && status.sequence > dead->sequence &&
        HeldAgainst(member.replaced_at, now) > kOnItsWay) {
      Fail(fmt::format("two processes are the {}: pid {} on {} and pid {} on {}", status.role,
                       member.status->pid, member.status->host, status.pid, status.host));
    }
    return false;
  }
  if (status.host == host_ && std::ranges::find(member.pids, status.pid) != member.pids.end()) {
    return false;
  }
  if (!member.status) return true;
  if (same(*member.status)) {
    const bool speaks = status.sequence > member.status->sequence;
    if (speaks && member.rival && HeldAgainst(member.rival_since, now) > kOnItsWay) {
      Fail(fmt::format("two processes are the {}: pid {} on {} and pid {} on {}", status.role,
                       status.pid, status.host, member.rival->pid, member.rival->host));
    }
    return true;
  }
  if (!member.rival || !same(*member.rival)) {
    member.rival = status;
    member.rival_since = now;
  }
  if (!IsExternal(role) || HeldAgainst(member.heard, now) <= kSilent) return false;
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
  member.replaced_at = now;
  return true;
}

void Conductor::Bury(Role role, std::int32_t pid, TimePoint now) {
  Member& member = members_[static_cast<std::size_t>(role)];
  member.pids.push_back(pid);
  if (member.status && member.status->pid == pid && member.status->host == host_) {
    member.dead.push_back(std::move(*member.status));
    member.status.reset();
  }
  member.rival.reset();
  progressed_ = now;  // somebody is at work to get the run going again
}

void Conductor::Launched(Role role, std::int32_t pid, TimePoint now) {
  std::erase(members_[static_cast<std::size_t>(role)].pids, pid);
  progressed_ = now;
}

void Conductor::OnResend(Bytes bytes) {
  resend_t resend{};
  if (const RefusalCounter wrong = Examine(bytes, resend)) return Refuse(wrong);
  if (resend.header.run_id != options_.run_id) return Refuse(&status_t::foreign);
  if (resend.channel != ChannelOf<run_t>().name) return;
  // Who misses one part usually misses most of them: everything from there on is sent.
  const TimePoint now = Clock::now();
  if (now < parts_at_ || resend.header.step < 0) return;
  parts_at_ = now + kPartsEvery;
  for (auto i = static_cast<std::size_t>(resend.header.step); i < parts_.size(); ++i) {
    Announce(i, resend.instance);
  }
}

void Conductor::Announce(std::size_t part, std::int64_t answer_to) {
  // A run in real time that goes waits for nobody: who joins late joins a run that goes.
  const bool go = ready_ || (options_.realtime && phase_ == Phase::kRunning);
  Announce(go ? run_t::GO : run_t::PREPARE, part, answer_to);
}

void Conductor::Announce(std::int8_t phase, std::size_t part, std::int64_t answer_to) {
  run_t run = MakeRunPart(options_.run_id, phase, options_.pace, hash_, parts_, part);
  run.sequence = ++sequence_;
  run.answer_to = answer_to;
  run.progress = progress_;
  run.realtime = options_.realtime;
  run.minimal_risk = minimal_risk_;
  Encode(run, buffer_);
  bus_.Publish(ChannelOf<run_t>().name, buffer_);
}

std::string Conductor::Where() const {
  return step() < 0 ? "before step 0" : fmt::format("at step {}", step());
}

std::string Conductor::Culprit(TimePoint now) const {
  // From the world up along what each role waits for, to the first that does not say why. The step
  // is the one that the role in question works on: the world is a step ahead of the others.
  std::int64_t stuck = step() + 1;
  Role waiting = Role::kWorld;
  for (std::size_t hops = 0; hops < kRoles.size(); ++hops) {
    const Member& consumer = member(waiting);
    if (!consumer.status || HeldAgainst(consumer.heard, now) > kSilent) {
      return fmt::format("step {}: {} is silent (last heard: step {}, {:.1f} s ago)", stuck,
                         NameOf(waiting), consumer.status ? consumer.status->header.step : -1,
                         Seconds(now - consumer.heard));
    }
    stuck = consumer.status->header.step + 1;
    const std::size_t place = ChannelNamed(consumer.status->waiting_for);
    const ChannelInfo* channel = place < kNumChannels ? &kChannels[place] : nullptr;
    const Role producer = channel != nullptr ? channel->from : Role::kRecorder;
    const Member& source = member(producer);
    // Who has computed what is waited for may wait himself, but for something else.
    const bool done = channel != nullptr && source.status &&
                      source.status->header.step >= stuck - LagOf(producer, waiting);
    const bool passes_on = source.status && HeldAgainst(source.heard, now) <= kSilent && !done &&
                           !source.status->waiting_for.empty() && producer != waiting;
    if (passes_on) {
      waiting = producer;
      continue;
    }
    // The consumer knows about the channel; about the log we know ourselves.
    using Known = std::tuple<std::string_view, std::int64_t, Duration>;
    const auto [what, last, age] =
        channel != nullptr
            ? Known(channel->name, consumer.status->last_heard_step,
                    now - consumer.heard + milliseconds(consumer.status->last_heard_ms))
            : Known("the log", source.status ? source.status->header.step : -1, now - source.heard);
    return fmt::format("step {}: {} waits for {} from {} (last heard: step {}, {:.1f} s ago)",
                       stuck, NameOf(waiting), what, NameOf(producer), last, Seconds(age));
  }
  return fmt::format("step {}: every role waits for another", stuck);
}

}  // namespace fogline
