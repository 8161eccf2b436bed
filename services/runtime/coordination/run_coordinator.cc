#include "services/runtime/coordination/run_coordinator.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "common/process/this_process.h"
#include "common/text.h"
#include "services/runtime/lockstep/possible_status.h"
#include "services/runtime/node/own_status.h"

namespace fogline::runtime {
namespace {

constexpr Duration kAnnounceEvery = milliseconds(50);
// The interval between two RUN messages while the run goes on. For roles that were started
// elsewhere, each RUN shows that the runner is alive.
constexpr Duration kRepeatEvery = milliseconds(200);
// All requests for parts of the scenario within this time get one answer.
constexpr Duration kPartsEvery = milliseconds(10);
// If the recorder's report of the last step was lost, the runner asks for it at this interval.
constexpr Duration kAskRecorderEvery = milliseconds(5);
// In real time, a STATUS is refused if its step is more than this many steps above the number of
// periods since the run began (NewestPossible()). We chose this margin.
constexpr std::int64_t kEarly = 2;
// The largest difference between the rates of two machines' clocks. The kernel's NTP discipline
// changes the rate by 500 ppm at most (adjtimex(2)), and a crystal is off by less than 100 ppm. So
// two machines may differ by twice the sum, 1200 ppm. We round up. A daemon that changes the length
// of a tick can change the rate by more.
constexpr double kClockDrift = 2e-3;

std::optional<Role> RoleNamed(std::string_view name) {
  for (const RoleInfo& info : kRoles) {
    if (info.name == name) return info.role;
  }
  return std::nullopt;
}

}  // namespace

RunCoordinator::RunCoordinator(Bus& bus, RunCoordinatorOptions options)
    : bus_(bus),
      options_(std::move(options)),
      parts_(SplitScenario(options_.scenario_text)),
      hash_(HashOf(options_.scenario_text)),
      signs_of_life_(OwnStatus::kHeartbeat),
      deaf_(options_.realtime ? options_.period : Duration::zero()),
      host_(HostName()),
      began_(Clock::now()),
      pauses_(began_),
      sequence_(options_.sequence),
      progress_(options_.progress) {
  bus_.Subscribe(ChannelOf<status_t>().name, [this](Arrival& arrival) {
    if (const RefusalCounter wrong = arrival.Wrong<status_t>()) return Refuse(wrong);
    OnStatus(*arrival.As<status_t>());
  });
  bus_.Subscribe(ChannelOf<resend_t>().name, [this](Bytes bytes) { OnResend(bytes); },
                 {.offset = kHeaderEnd, .texts = {EncodedText(ChannelOf<run_t>().name)}});
}

TimePoint RunCoordinator::Poll(TimePoint now) {
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
    going_since_ = now;
  }
  // A recorder that reads a long log reports its progress. So the join limit counts from the last
  // progress. The wait for external roles does not count here, because a person starts these roles.
  // The runner limits this wait (--wait).
  if (phase_ == Phase::kJoining && !Awaited(now).empty()) awaited_ = now;
  if (const Duration joining = HeldAgainst(std::max({began_, progressed_, awaited_}), now);
      phase_ == Phase::kJoining && options_.join_limit > Duration::zero() &&
      joining > (AllPrepare(now) ? options_.prepare_limit : options_.join_limit)) {
    Fail(fmt::format("not ready after {:.1f} s: {}", Seconds(joining), NotReady()));
  }
  if (const Bus::FailedSends& failed = bus_.failed_sends(); failed.count != own_.sends_failed) {
    own_.sends_failed = failed.count;
    own_.send_error = failed.error;
  }
  if (const auto since = bus_.failed_sends().since;
      since && HeldAgainst(*since, now) > options_.stall_limit) {
    Fail(fmt::format("nothing could be sent for {:.1f} s: {}", Seconds(now - *since),
                     own_.send_error));
  }
  if (phase_ == Phase::kRunning && HeldAgainst(progressed_, now) > options_.stall_limit) {
    Fail(Culprit(now));
  }
  if (phase_ == Phase::kJoining || phase_ == Phase::kRunning) AnnounceWhenDue(now);
  FinishWhenRecorded(now);
  return std::min(announce_at_, ask_recorder_at_.value_or(now + kAnnounceEvery));
}

void RunCoordinator::FinishWhenRecorded(TimePoint now) {
  const auto& world = member(Role::kWorld).status;
  const auto& recorder = member(Role::kRecorder).status;
  const bool under_way = phase_ == Phase::kJoining || phase_ == Phase::kRunning;
  if (!under_way || !world || world->state != status_t::DONE) return;
  if (options_.realtime || (recorder && recorder->header.step >= world->header.step)) {
    return OnDone();
  }
  if (ask_recorder_at_ && now >= *ask_recorder_at_) {
    resend_t question{};
    question.header = {.run_id = options_.run_id, .step = world->header.step, .utime = 0};
    question.channel = ChannelOf<status_t>().name;
    question.count = 1;
    question.requester = NameOf(Role::kRunner);
    Encode(question, buffer_);
    bus_.Publish(ChannelOf<resend_t>().name, buffer_);
  }
  if (!ask_recorder_at_ || now >= *ask_recorder_at_) ask_recorder_at_ = now + kAskRecorderEvery;
}

void RunCoordinator::AnnounceWhenDue(TimePoint now) {
  if (now < announce_at_) return;
  // RUN is sent at the shorter interval until every role is ready and the world has started.
  const auto& world = member(Role::kWorld).status;
  const bool going = ready_ && world && world->state != status_t::READY;
  // Roles ask for the parts of the scenario that they lack. Programs that only listen cannot ask,
  // so they get one part after another while the run goes on.
  Announce(going ? next_part_++ % parts_.size() : 0);
  announce_at_ = now + (going ? kRepeatEvery : kAnnounceEvery);
}

bool RunCoordinator::AllReady(TimePoint now) const {
  return std::ranges::none_of(kRoles, [&](const RoleInfo& info) {
    return Lacks(info.role, now) || HasRival(info.role, now);
  });
}

bool RunCoordinator::Lacks(Role role, TimePoint now) const {
  const Member& of = member(role);
  const bool lost =
      phase_ == Phase::kRunning && IsExternal(role) && HeldAgainst(of.heard, now) > kSilent;
  return !of.status || of.status->state == status_t::WAITING || lost;
}

std::vector<Role> RunCoordinator::Awaited(TimePoint now) const {
  std::vector<Role> awaited;
  for (const RoleInfo& info : kRoles) {
    if (IsExternal(info.role) && Lacks(info.role, now)) awaited.push_back(info.role);
  }
  return awaited;
}

std::string RunCoordinator::NotReady() const {
  std::string names;
  for (const RoleInfo& info : kRoles) {
    const auto& status = member(info.role).status;
    if (status && status->state != status_t::WAITING) continue;
    names += fmt::format("{}{}{}{}", names.empty() ? "" : ", ", info.name,
                         status ? "" : " (never heard)", HindranceOf(info.role));
  }
  return names;
}

std::string RunCoordinator::WhereOrWaiting() const {
  const std::string names = phase_ == Phase::kJoining ? NotReady() : "";
  return names.empty() ? Where() : "while waiting for " + names;
}

std::int64_t RunCoordinator::Total(std::int64_t status_t::*counter) const {
  std::int64_t total = 0;
  for (const Member& member : members_) {
    if (member.status) total += (*member.status).*counter;
    for (const status_t& status : member.dead) total += status.*counter;
  }
  return total;
}

Refusals RunCoordinator::Refused() const {
  Refusals refused{};
  std::ranges::transform(kRefusals, refused.begin(), [this](const RefusalKind& kind) {
    return Total(kind.counter) + own_.*kind.counter;
  });
  return refused;
}

std::vector<SendTrouble> RunCoordinator::SendTroubles() const {
  std::vector<SendTrouble> troubles;
  const auto add = [&troubles](std::string_view role, const status_t& status) {
    if (status.sends_failed == 0) return;
    if (troubles.empty() || troubles.back().role != role) troubles.push_back({std::string(role)});
    troubles.back().count += status.sends_failed;
    troubles.back().error = status.send_error;
  };
  for (const RoleInfo& info : kRoles) {
    for (const status_t& status : member(info.role).dead) add(info.name, status);
    if (const auto& status = member(info.role).status) add(info.name, *status);
  }
  add("runner", own_);
  return troubles;
}

std::string RunCoordinator::KeyTrouble() const {
  return SignatureTrouble({.not_signed = Total(&status_t::not_signed) + own_.not_signed,
                           .badly_signed = Total(&status_t::badly_signed) + own_.badly_signed,
                           .no_key = bus_.unverified().no_key});
}

void RunCoordinator::Stop() { Announce(run_t::STOP, 0); }

void RunCoordinator::Fail(std::string error) {
  if (phase_ == Phase::kFailed || phase_ == Phase::kDone) return;
  phase_ = Phase::kFailed;
  error_ = std::move(error) + RefusedText();
  if (const std::string trouble = KeyTrouble(); !trouble.empty()) error_ += "\n  " + trouble;
  if (const auto troubles = SendTroubles(); !troubles.empty()) {
    error_ += "\n  messages that could not be sent: " + Text(troubles);
  }
}

void RunCoordinator::OnStatus(const status_t& heard) {
  if (heard.header.run_id != options_.run_id) {
    foreign_peers_.Hear(heard);
    return Refuse(&status_t::foreign);
  }
  const TimePoint now = Clock::now();
  if (!IsPossible(heard) || heard.header.step > NewestPossible(now))
    return Refuse(&status_t::out_of_window);
  status_t status = heard;  // a copy with texts that are safe to print
  status.host = EscapeControls(heard.host);
  status.error = EscapeControls(heard.error);
  status.send_error = EscapeControls(heard.send_error);
  const auto role = RoleNamed(status.role);
  if (!role) return Refuse(&status_t::malformed);
  // After the end of the run, only the recorder's STATUS counts, because it reports how much of the
  // log is written.
  const bool over = phase_ != Phase::kJoining && phase_ != Phase::kRunning;
  if (over && role != Role::kRecorder) return;
  Attend(now);
  if (!Admit(*role, status, now)) return;
  Member& member = members_[static_cast<std::size_t>(*role)];
  if (member.status && status.sequence <= member.status->sequence) return;  // not the newest
  const bool joined = status.state == status_t::READY || status.state == status_t::RUNNING;
  if (joined && status.scenario_hash != hash_) {
    return Fail(fmt::format("{} (pid {} on {}) has another scenario", status.role, status.pid,
                            status.host));
  }
  if (joined && status.type_fingerprint != TypeFingerprint()) {
    return Fail(fmt::format("{} (pid {} on {}) was built with other message types", status.role,
                            status.pid, status.host));
  }
  // Each instance is compared with its own last step. So the steps of a process that was started
  // again and catches up count as progress, although the role's earlier process had reached a later
  // step.
  if (member.status && status.header.step > member.status->header.step) progressed_ = now;
  progress_ = std::max(progress_, status.header.step);
  signs_of_life_.Heard(*role, member.status ? status.sequence - member.status->sequence - 1 : 0,
                       now);
  deaf_.Heard(*role, status, now);
  member.status = status;
  member.heard = now;
  const bool decides = *role == Role::kWorld || *role == Role::kArbitrator;
  if (const auto cars = static_cast<std::int8_t>(minimal_risk_ | status.minimal_risk);
      decides && cars != minimal_risk_) {
    minimal_risk_ = cars;
    announce_at_ = now;
  }
  if (on_status_) on_status_(status);
  if (options_.same_build) {
    if (const auto other = OtherBuildOf(*role, status, options_.builds)) {
      return Fail(other->Text() + " (--same-build)");
    }
  }
  if (member.status->state == status_t::FAILED) return OnFailure(*role, status);
  FinishWhenRecorded(now);
}

std::int64_t RunCoordinator::NewestPossible(TimePoint now) const {
  if (!options_.realtime || options_.period == Duration::zero()) return options_.steps;
  const double going_s = phase_ == Phase::kJoining ? 0 : Seconds(now - going_since_);
  const double periods = going_s * (1 + kClockDrift) / Seconds(options_.period);
  // A world that is started again takes its first step immediately, and not one period after the
  // last step of the earlier process.
  const std::int64_t restarts = std::ssize(member(Role::kWorld).dead);
  return std::min(options_.steps, static_cast<std::int64_t>(periods) + kEarly + restarts);
}

void RunCoordinator::OnDone() {
  for (const RoleInfo& info : kRoles) {
    const auto deaf = deaf_.AtTheEnd(info.role);
    if (!deaf) continue;
    const status_t& status = *member(info.role).status;
    return Fail(fmt::format("{} (pid {} on {}) is deaf at the end of the run: it {}", info.name,
                            status.pid, status.host, Text(*deaf)));
  }
  phase_ = Phase::kDone;
}

void RunCoordinator::OnFailure(Role role, const status_t& status) {
  // A run in real time goes on if a role fails, except if the world or the recorder fails. The
  // failed role counts as lost, and the other roles have fallbacks for this case.
  if (GoesOnWithout(role)) return;
  Fail(fmt::format("{}: {}", status.role, status.error));
}

void RunCoordinator::OnResend(Bytes bytes) {
  resend_t resend{};
  if (const RefusalCounter wrong = Examine(bytes, resend)) return Refuse(wrong);
  if (resend.header.run_id != options_.run_id) return Refuse(&status_t::foreign);
  if (resend.channel != ChannelOf<run_t>().name) return;
  // A role that lacks one part of the scenario usually lacks most parts, so the runner sends this
  // part and all later parts.
  const TimePoint now = Clock::now();
  if (now < parts_at_ || resend.header.step < 0) return;
  parts_at_ = now + kPartsEvery;
  for (auto i = static_cast<std::size_t>(resend.header.step); i < parts_.size(); ++i) {
    Announce(i, resend.instance);
  }
}

void RunCoordinator::Announce(std::size_t part, std::int64_t answer_to) {
  // A run in real time that has started does not wait for missing roles. RUN then says GO even if a
  // role is missing, so a late role begins to compute as soon as it has joined.
  const bool go = ready_ || (options_.realtime && phase_ == Phase::kRunning);
  Announce(go ? run_t::GO : run_t::PREPARE, part, answer_to);
}

void RunCoordinator::Announce(std::int8_t phase, std::size_t part, std::int64_t answer_to) {
  const TimePoint now = pauses_.Attend(Clock::now());
  run_t run = MakeRunPart(options_.run_id, phase, options_.pace, hash_, parts_, part);
  run.sequence = ++sequence_;
  run.answer_to = answer_to;
  run.progress = progress_;
  run.realtime = options_.realtime;
  run.minimal_risk = minimal_risk_;
  run.stall_ms = Milliseconds(options_.stall_limit);
  for (const RoleInfo& info : kRoles) {
    // The runner starts some roles itself. RUN names such a role only if another process claims the
    // role.
    const std::int64_t holder = HolderOf(info.role, now);
    if (!IsExternal(info.role) && !(member(info.role).rival && holder != 0)) continue;
    run.external.emplace_back(info.name);
    run.holder.push_back(holder);
  }
  run.num_external = static_cast<std::int32_t>(run.external.size());
  Encode(run, buffer_);
  bus_.Publish(ChannelOf<run_t>().name, buffer_);
}

std::string RunCoordinator::Where() const {
  return step() < 0 ? "before step 0" : fmt::format("at step {}", step());
}

std::string RunCoordinator::HindranceOf(Role role) const {
  const Member& of = member(role);
  if (!of.hindrance.empty()) return "; " + of.hindrance;
  const bool left = !of.status && !of.dead.empty() && of.dead.back().state == status_t::LEFT;
  return left ? fmt::format("; it has left: {}", of.dead.back().error) : "";
}

std::string RunCoordinator::Culprit(TimePoint now) const {
  // Follows the chain of waiting roles from the world to the first role that does not say what it
  // waits for. `stuck` is the step that the current role of the chain cannot complete.
  std::int64_t stuck = step() + 1;
  Role waiting = Role::kWorld;
  for (std::size_t hops = 0; hops < kRoles.size(); ++hops) {
    const Member& consumer = member(waiting);
    if (!consumer.status || HeldAgainst(consumer.heard, now) > kSilent) {
      return fmt::format("step {}: {} is silent (last heard: step {}, {:.1f} s ago){}", stuck,
                         NameOf(waiting), consumer.status ? consumer.status->header.step : -1,
                         Seconds(now - consumer.heard), HindranceOf(waiting));
    }
    stuck = consumer.status->header.step + 1;
    const std::size_t place = ChannelNamed(consumer.status->waiting_for);
    const ChannelInfo* channel = place < kNumChannels ? &kChannels[place] : nullptr;
    const Role producer = channel != nullptr ? channel->from : Role::kRecorder;
    const Member& source = member(producer);
    // If the producer has already computed the step for which the consumer waits, the chain ends at
    // the consumer. What the producer itself waits for does not explain why the consumer waits.
    const bool done = channel != nullptr && source.status &&
                      source.status->header.step >= stuck - LagOf(producer, waiting);
    const bool passes_on = source.status && HeldAgainst(source.heard, now) <= kSilent && !done &&
                           !source.status->waiting_for.empty() && producer != waiting;
    if (passes_on) {
      waiting = producer;
      continue;
    }
    // The consumer's STATUS says when the consumer last received a message of the channel. For the
    // log, the time of the recorder's last STATUS counts.
    using Known = std::tuple<std::string_view, std::int64_t, Duration>;
    const auto [what, last, age] =
        channel != nullptr
            ? Known(channel->name, consumer.status->last_heard_step,
                    now - consumer.heard + milliseconds(consumer.status->last_heard_ms))
            : Known("the log", source.status ? source.status->header.step : -1, now - source.heard);
    return fmt::format("step {}: {} waits for {} from {} (last heard: step {}, {:.1f} s ago){}",
                       stuck, NameOf(waiting), what, NameOf(producer), last, Seconds(age),
                       HindranceOf(producer));
  }
  return fmt::format("step {}: every role waits for another", stuck);
}

}  // namespace fogline::runtime
