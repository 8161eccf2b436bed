#include "services/runtime/lockstep/step_gate.h"

#include <algorithm>

namespace fogline::runtime {
namespace {

constexpr Duration kFirstRetryInterval = milliseconds(20);
constexpr Duration kMaxRetryInterval = milliseconds(500);
// No step is due later than this time (three years) after the start. Without this limit, times
// could overflow at a very slow pace.
constexpr double kLongest_s = 1e8;

}  // namespace

StepGate::StepGate(Bus& bus, status_t& own) {
  bus.Subscribe(ChannelOf<status_t>().name, [this, &own](Arrival& arrival) {
    if (run_id_ == 0) return;  // the role is in no run yet
    const auto* status = arrival.As<status_t>();
    if (status == nullptr || status->header.run_id != run_id_) {
      ++(own.*(status == nullptr ? arrival.Wrong<status_t>() : &status_t::foreign));
      return;
    }
    // If the recorder has failed, the step that it reports may not be on disk.
    if (status->role != NameOf(Role::kRecorder) || status->state == status_t::FAILED) return;
    // The recorder cannot have a step that no world process of this run has begun. A STATUS with
    // such a step is refused.
    if (status->header.step > std::max(own.header.step, begun_before_)) {
      ++own.out_of_window;
      return;
    }
    recorded_ = std::max(recorded_, status->header.step);
  });
}

void StepGate::Configure(const Scenario& scenario, std::int64_t run_id) {
  step_s_ = scenario.step_s;
  run_id_ = run_id;
}

void StepGate::OnGo(const run_t& run, TimePoint now) {
  BegunBefore(run.progress);
  if (started_) return;
  started_ = true;
  pace_ = std::max(0.0, run.pace);
  // A world that joins late computes the old steps without waiting, and keeps to the pace only in
  // later steps.
  start_ = now;
  start_ -= Due(std::max<std::int64_t>(0, run.progress)) - now;
}

TimePoint StepGate::Due(std::int64_t step) const {
  if (pace_ == 0) return start_;
  const std::chrono::duration<double> since(
      std::min(static_cast<double>(step) * step_s_ / pace_, kLongest_s));
  return start_ + duration_cast<Duration>(since);
}

bool StepGate::Open(std::int64_t step, TimePoint now) const {
  return started_ && !(final_ && step > *final_) && recorded_ >= Needed(step) && now >= Due(step);
}

std::optional<std::int64_t> StepGate::WantsRecorded(std::int64_t next, TimePoint now) {
  if (!started_ || recorded_ >= Needed(next)) {
    ask_at_.reset();
    return std::nullopt;
  }
  if (!ask_at_) {
    retry_interval_ = kFirstRetryInterval;
    ask_at_ = now + retry_interval_;
  }
  if (now < *ask_at_) return std::nullopt;
  retry_interval_ = std::min(2 * retry_interval_, kMaxRetryInterval);
  ask_at_ = now + retry_interval_;
  return Needed(next);
}

TimePoint StepGate::NextPoll(std::int64_t next, TimePoint now) const {
  if (!started_) return now + kMaxRetryInterval;
  TimePoint at = now + kMaxRetryInterval;
  if (ask_at_) at = std::min(at, *ask_at_);
  if (const TimePoint due = Due(next); due > now) at = std::min(at, due);
  return at;
}

}  // namespace fogline::runtime
