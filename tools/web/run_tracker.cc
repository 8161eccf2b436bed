#include "tools/web/run_tracker.h"

#include <algorithm>
#include <utility>

#include "scenario/io/json.h"
#include "scenario/io/loader.h"
#include "services/graph.h"
#include "tools/watch/step_sequence.h"

namespace fogline::web {
namespace {

/// The section of a scenario that says whether a person drives; its defaults if the scenario is not
/// valid.
PersonSection PersonOf(const std::string& scenario_text) {
  try {
    return ParseScenario(scenario_text).person;
  } catch (const ScenarioError&) {
    return {};
  }
}

}  // namespace

void RunTracker::Hear(std::size_t channel, runtime::Bytes bytes, TimePoint now) {
  if (channel >= kNumChannels || bytes.size() < runtime::kHeaderEnd) return;
  if (channel == IndexOf<run_t>()) return HearRun(bytes, now);
  if (!run_id_ || runtime::ReadInt64(bytes, runtime::kRunIdOffset) != *run_id_) return;
  NoteLife(now);
  HearStep(channel, bytes);
}

void RunTracker::NoteLife(TimePoint now) {
  if (now - heard_ > kSilent) may_begin_again_ = true;
  heard_ = now;
}

void RunTracker::HearRun(runtime::Bytes bytes, TimePoint now) {
  run_t run{};
  if (!runtime::Decode(bytes, run) || run.num_parts > kMostParts) return;
  if (only_ && run.header.run_id != *only_) return;
  const bool free = !run_id_ || stopped_ || left_ || now - heard_ > kSilent;
  if (run_id_ != run.header.run_id) {
    if (!free || run.phase == run_t::STOP) return;
    Begin(run);
  }
  NoteLife(now);
  left_ = false;
  realtime_ = run.realtime != 0;
  events_.set_may_lack_commands(realtime_);
  stopped_ = run.phase == run_t::STOP;
  may_begin_again_ = may_begin_again_ || stopped_;
  const bool known = parts_.Complete();
  if (!parts_.Add(run) || known || !parts_.Complete() || !parts_.HashHolds()) return;
  Show({.run_id = run.header.run_id,
        .scenario_text = parts_.Text(),
        .realtime = run.realtime != 0,
        .pace = run.pace});
}

void RunTracker::Show(RunFacts run) {
  // Any program may have sent the text. Fogline's own parser limits the depth of the JSON before
  // other parsers handle it recursively.
  DiagnosticList mistakes;
  std::string text = ParseJson(run.scenario_text, 0, mistakes) ? RunText(run) : "";
  if (text.empty()) {
    ++refused_scenarios_;
    return;
  }
  person_ = PersonOf(run.scenario_text);
  events_.set_person(person_);
  shown_ = std::move(run);
  shown_text_ = std::move(text);
  taken_ = 0;
  ++runs_;
}

std::vector<RunEvent> RunTracker::TakeEvents() {
  const auto& all = events_.events();
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(std::exchange(taken_, all.size()));
  return {begin, all.end()};
}

void RunTracker::ForgetEvents() {
  events_ = {};
  events_.set_may_lack_commands(realtime_);
  events_.set_person(person_);
  taken_ = 0;
}

void RunTracker::Begin(const run_t& run) {
  run_id_ = run.header.run_id;
  parts_ = {};
  person_ = {};
  ForgetEvents();
  newest_ = -1;
  may_begin_again_ = false;
  offered_ = false;
}

void RunTracker::HearStep(std::size_t channel, runtime::Bytes bytes) {
  if (kChannels[channel].pace != Pace::kStep) return;
  const std::int64_t step = runtime::ReadInt64(bytes, runtime::kStepOffset);
  if (step < 0 || step > watch::StepSequence::kMaxStep) return;
  if (channel == IndexOf<truth_t>() && step < newest_ && may_begin_again_) {
    ForgetEvents();
    newest_ = -1;
  }
  if (step > newest_) {
    newest_ = step;
    may_begin_again_ = false;
  }
  if (channel == IndexOf<truth_t>() && runtime::Decode(bytes, truth_)) events_.Add(truth_);
  if (channel == IndexOf<driver_command_t>()) offered_ = runtime::Decode(bytes, driver_);
  if (channel == IndexOf<arbitration_t>() && runtime::Decode(bytes, command_)) {
    const bool offered = offered_ && driver_.header.step == command_.header.step;
    events_.Add(command_, offered ? std::optional(driver_.acceleration_mps2) : std::nullopt);
  }
}

}  // namespace fogline::web
