#include "services/runtime/node/membership.h"

#include <algorithm>

#include <fmt/core.h>

#include "common/process/this_process.h"
#include "scenario/io/loader.h"

namespace fogline::runtime {
namespace {

// The role asks for a missing part of the scenario at this interval.
constexpr Duration kPartRetry = milliseconds(20);
// The runner repeats PREPARE until all roles are ready. A role that is ready answers with its
// STATUS, but not more often than at this interval.
constexpr Duration kAnnouncedRetry = milliseconds(20);
// If the runner is silent for this time, a role that has not received the whole scenario yet leaves
// the run and looks for another run.
constexpr Duration kAnnouncerSilence = milliseconds(5'000);

}  // namespace

Membership::Membership(Parts& parts, std::optional<std::int64_t> run_id, Work& work,
                       std::unique_ptr<FireRule>& rule)
    : parts_(parts),
      run_(parts.run),
      own_(parts.own),
      work_(work),
      rule_(rule),
      chosen_(run_id.has_value()),
      fresh_(!parts.bus.secured()),
      ends_with_runner_(chosen_ && EndsWithItsParent()) {
  run_.id = run_id;
  parts_.bus.Subscribe(ChannelOf<run_t>().name, [this](Bytes bytes) { OnRun(bytes); });
}

TimePoint Membership::Poll(TimePoint now) {
  runner_.Attend(now);
  if (own_.Waits() && runner_.Silence(now) > kAnnouncerSilence && !chosen_) Unbind();
  if (!own_.Waits() && runner_.Gone(now) && !ends_with_runner_) {
    own_.Fail(
        fmt::format("the runner has been silent for {:.0f} s", Seconds(runner_.Silence(now))));
  }
  if (LogIsOver(now)) own_.Leave();
  if (own_.HastensForFailedSends()) CheckSends(now);
  if (own_.left() || !own_.Waits() || !run_.id) return TimePoint::max();
  if (now >= part_at_) {
    parts_.requests.Ask(ChannelOf<run_t>().name, {.first = run_.parts.FirstMissing(), .count = 1});
    part_at_ = now + kPartRetry;
  }
  return part_at_;
}

void Membership::CheckSends(TimePoint now) {
  const Bus::FailedSends& failed = parts_.bus.failed_sends();
  // A role that waits for a run or its scenario does not fail: the run waits for it, and the runner
  // decides for how long. A role in real time does not fail either: the other roles go on without
  // it, and the runner decides how long the role may be silent.
  if (own_.left() || own_.Waits() || run_.realtime || !failed.since ||
      !runner_.Stalled(std::max(*failed.since, joined_), now))
    return;
  own_.Fail(fmt::format("nothing could be sent for {:.1f} s: {}", Seconds(now - *failed.since),
                        failed.error));
}

void Membership::OnRun(Bytes bytes) {
  if (own_.left() || own_.released()) return;  // the role has left, and its files are closed
  run_t run{};
  if (const RefusalCounter wrong = Examine(bytes, run)) return own_.Refuse(wrong);
  const TimePoint now = Clock::now();
  if (run_.id ? run.header.run_id != *run_.id : run.phase == run_t::STOP) {
    OnOtherRun(run, now);
    return own_.Refuse(&status_t::foreign);
  }
  // A RUN from a played log has the sequence number 0. A role does not join a run because of such a
  // RUN.
  if (!run_.id && run.sequence < 1) return own_.Refuse(&status_t::foreign);
  const status_t& own = own_.message();
  if (!run_.id && SeatIn(run, own.role, own.instance) != Seat::kFree) {
    run_.full = run.header.run_id;
    return;
  }
  if (run.progress > run_.steps) return own_.Refuse(&status_t::out_of_window);
  if (run.realtime && !IsSpeed(run.pace)) return own_.Refuse(&status_t::malformed);
  if (!IsFresh(run, now)) return;
  if (own_.Waits() && run.phase != run_t::STOP && !run_.parts.Add(run)) {
    return own_.Refuse(&status_t::malformed);
  }
  run_.id = run.header.run_id;
  const bool news = TakeNews(run, now);
  if (!own_.left() && own_.Waits() && run_.parts.Complete()) Join(run);
  if (news && run.phase == run_t::GO && own_.Running()) rule_->OnGo(run, now);
}

void Membership::OnOtherRun(const run_t& run, TimePoint now) {
  now = runner_.Attend(now);
  const status_t& own = own_.message();
  const bool may_go = run_.id && !chosen_ && runner_.Silent(now) && run.phase != run_t::STOP;
  if (!may_go || SeatIn(run, own.role, own.instance) != Seat::kFree) return;
  // A signed RUN may be a copy from an old run. So the role leaves its run only because of a RUN
  // that answers a request of this process.
  if (parts_.bus.secured() && run.answer_to != own.instance) return AskWhetherThere(run, now);
  own_.Release(
      fmt::format("the runner of run {} has been silent for {:.1f} s; run {} waits for the {}",
                  *run_.id, Seconds(runner_.Silence(now)), run.header.run_id, own.role));
}

bool Membership::IsFresh(const run_t& run, TimePoint now) {
  if (fresh_) return true;
  fresh_ = run.answer_to == own_.message().instance;
  if (!fresh_) AskWhetherThere(run, now);
  return fresh_;
}

void Membership::AskWhetherThere(const run_t& run, TimePoint now) {
  if (!questions_.Take(now)) return;
  parts_.requests.AskIn(run.header.run_id, ChannelOf<run_t>().name, {.first = 0, .count = 1});
}

bool Membership::HasLostItsPlace(const run_t& run, TimePoint now) {
  const std::int64_t instance = own_.message().instance;
  if (SeatIn(run, own_.message().role, instance) != Seat::kTaken) return false;
  if (!chosen_ || run.answer_to == instance) return true;
  AskWhetherThere(run, now);
  return false;
}

bool Membership::LogIsOver(TimePoint now) {
  if (!chosen_ || run_.sequence > 0 || !own_.Running()) return false;
  TimePoint heard = joined_;
  for (const Input& input : parts_.inputs.all()) heard = std::max(heard, input.heard);
  return runner_.GoneSince(heard, now);
}

bool Membership::TakeNews(const run_t& run, TimePoint now) {
  if (run.sequence <= run_.sequence) {
    ++own_.message().duplicates;
    return false;
  }
  run_.sequence = run.sequence;
  runner_.Heard(run, now);
  run_.progress = std::max(run_.progress, run.progress);
  run_.minimal_risk = run.minimal_risk;
  if (rule_) rule_->OnProgress();
  const status_t& own = own_.message();
  if (run.phase == run_t::STOP) {
    own_.Leave();
  } else if (HasLostItsPlace(run, now)) {
    own_.Release(fmt::format("another process is the {} of run {}", own.role, run.header.run_id));
  } else if (!own_.Waits() && run.phase == run_t::PREPARE && run.header.step == 0 &&
             now >= announced_at_ + kAnnouncedRetry) {
    announced_at_ = now;
    own_.Publish();  // the runner repeats PREPARE: perhaps it has no STATUS of this role
  }
  return true;
}

void Membership::Unbind() {
  run_ = {};
  fresh_ = !parts_.bus.secured();
  runner_.Forget();
}

void Membership::Join(const run_t& run) {
  if (!run_.parts.HashHolds()) {
    return own_.Fail("the scenario that arrived does not match its hash");
  }
  joined_ = Clock::now();
  run_.realtime = run.realtime;
  run_.pace = run.pace;
  try {
    if (run_.realtime) parts_.bus.KeepBacklog();
    const Scenario scenario = ParseScenario(run_.parts.Text());
    run_.steps = scenario.steps;
    run_.progress = std::min(run_.progress, run_.steps);
    rule_ = work_.Join(scenario);
  } catch (const std::exception& error) {
    return own_.Fail(fmt::format("cannot take part: {}", error.what()));
  }
  before_ready_();
  own_.SetState(status_t::READY);
}

}  // namespace fogline::runtime
