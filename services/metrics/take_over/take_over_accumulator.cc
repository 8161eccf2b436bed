#include "services/metrics/take_over/take_over_accumulator.h"

#include <algorithm>
#include <utility>

#include "services/decision/take_over/take_over.h"
#include "services/graph.h"
#include "services/host_modes.h"

namespace fogline::metrics {
namespace {

double Seconds(std::int64_t us) { return static_cast<double>(us) / kMicrosPerSecond; }

bool ExcludesASensor(const track_t& track) {
  return std::ranges::find(track.usage, track_t::DISTRUSTED) != std::end(track.usage);
}

/// Whether the judged interval of a request (take_over_measures.h) ends in a step with this mode
/// and this speed.
bool IsOver(std::int8_t mode, double speed_mps) {
  if (mode == arbitration_t::MINIMAL_RISK) return speed_mps < take_over::kStandstill_mps;
  return mode == arbitration_t::AUTOMATION || mode == arbitration_t::HUMAN ||
         mode == arbitration_t::MRM_DONE;
}

}  // namespace

std::string_view NameOf(TakeOverEnd end) {
  switch (end) {
    case TakeOverEnd::kOpen:
      return "open";
    case TakeOverEnd::kTakenOver:
      return "taken_over";
    case TakeOverEnd::kTakenOverLate:
      return "taken_over_late";
    case TakeOverEnd::kMinimalRisk:
      return "minimal_risk";
    case TakeOverEnd::kWithdrawn:
      return "withdrawn";
    case TakeOverEnd::kFallback:
      return "fallback";
    case TakeOverEnd::kUnknown:
      return "unknown";
  }
  return "";
}

// The acceleration in the TRUTH of a step was applied before this step. So the acceleration results
// from earlier commands, and AddMotion() comes before AddCommand().
void TakeOverAccumulator::Add(const truth_t& truth, const arbitration_t* command,
                              const track_t* track, std::optional<double> human_mps2) {
  const bool first = !late_;
  if (first) late_ = truth.header.step > 0;
  AddFog(truth, first);
  // Step 0 does not count, because no acceleration was applied before it.
  std::optional<double> jerk_mps3;
  if (truth.header.step > 0) {
    jerk_mps3 = jerk_.Add(Seconds(truth.header.utime), truth.host_acceleration_mps2);
  }
  if (judged_) {
    AddDriving(truth.header.utime);
    AddMotion(truth, jerk_mps3);
  }
  if (command != nullptr) AddCommand(truth, *command, human_mps2);
  if (track != nullptr) excludes_ = ExcludesASensor(*track);
}

void TakeOverAccumulator::AddFog(const truth_t& truth, bool first) {
  const bool was_foggy = std::exchange(foggy_, truth.fog_present != 0);
  const bool began_before = first && *late_;
  if (!foggy_) fog_speed_mps_.reset();
  if (foggy_ && !was_foggy && !began_before) fog_speed_mps_ = truth.host_speed_mps;
}

void TakeOverAccumulator::AddDriving(std::int64_t utime) {
  const std::int64_t time_us = utime - judged_->last_us;
  judged_->last_us = utime;
  const std::int8_t mode = log_.mode();
  if (InMinimalRisk(mode)) {
    judged_->manoeuvre_us += time_us;
  } else if (HumanDrives(mode)) {
    judged_->driver_us += time_us;
  } else {
    judged_->automation_us += time_us;
    if (excludes_) judged_->excluded_us += time_us;
  }
}

void TakeOverAccumulator::AddMotion(const truth_t& truth, std::optional<double> jerk_mps3) {
  TakeOverMeasures& request = requests_.back();
  const double deceleration_mps2 = -truth.host_acceleration_mps2;
  Raise(request.max_deceleration_mps2, std::max(0.0, deceleration_mps2));
  if (deceleration_mps2 > 0) judged_->deceleration_mps2.Add(deceleration_mps2);
  if (jerk_mps3) Raise(request.max_abs_jerk_1s_mps3, *jerk_mps3);
  if (!jerk_mps3 && *late_) judged_->jerk_unknown = true;
  Look(truth);
}

void TakeOverAccumulator::AddCommand(const truth_t& truth, const arbitration_t& command,
                                     std::optional<double> human_mps2) {
  log_.Add(command, human_mps2);
  log_.DropEntries();
  if (log_.requests().size() > requests_.size()) Begin(truth);
  if (requests_.empty()) return;
  NoteTimes(truth.header.utime);
  if (!judged_) return;
  NoteOutcome(log_.mode());
  if (IsOver(log_.mode(), truth.host_speed_mps)) End();
}

void TakeOverAccumulator::Begin(const truth_t& truth) {
  End();
  requested_us_ = truth.header.utime;
  requests_.push_back(
      {.requested_s = Seconds(requested_us_), .speed_at_request_mps = truth.host_speed_mps});
  judged_.emplace().last_us = requested_us_;
  judged_->fog_unknown = foggy_ && !fog_speed_mps_;
  Look(truth);
}

void TakeOverAccumulator::Look(const truth_t& truth) {
  TakeOverMeasures& request = requests_.back();
  request.judged_s = Seconds(truth.header.utime - requested_us_);
  if (!request.speed_at_fog_mps && !judged_->fog_unknown) request.speed_at_fog_mps = fog_speed_mps_;
  // The duration of a step is given as 0, because the measures that depend on it are not used.
  judged_->pair.Add({truth.host_gap_m, truth.host_speed_mps, truth.preceding_speed_mps}, 0);
}

// TakeOverLog notes an event in the step in which the event happens. So the time of this step is
// the time of each event that is noted for the first time.
void TakeOverAccumulator::NoteTimes(std::int64_t utime) {
  const take_over::TakeOverRequest& noted = log_.requests().back();
  TakeOverMeasures& request = requests_.back();
  const auto note = [&](std::optional<double>& time_s, bool happened) {
    if (happened && !time_s) time_s = Seconds(utime - requested_us_);
  };
  note(request.reaction_time_s, noted.acknowledged.has_value());
  note(request.take_over_time_s, noted.transferred.has_value());
  note(request.effective_input_time_s, noted.effective.has_value());
  note(request.manoeuvre_time_s, noted.manoeuvre.has_value());
}

void TakeOverAccumulator::NoteOutcome(std::int8_t mode) {
  TakeOverEnd& outcome = requests_.back().outcome;
  if (mode == arbitration_t::RECOVERING) {
    if (outcome == TakeOverEnd::kOpen) outcome = TakeOverEnd::kTakenOver;
    if (outcome == TakeOverEnd::kMinimalRisk) outcome = TakeOverEnd::kTakenOverLate;
  }
  if (outcome != TakeOverEnd::kOpen) return;
  if (InMinimalRisk(mode)) outcome = TakeOverEnd::kMinimalRisk;
  if (mode == arbitration_t::AUTOMATION) outcome = TakeOverEnd::kWithdrawn;
  if (mode == arbitration_t::HUMAN) outcome = TakeOverEnd::kFallback;
}

void TakeOverAccumulator::End() {
  if (judged_) Finish(*judged_, requests_.back());
  judged_.reset();
}

void TakeOverAccumulator::Finish(const Judged& judged, TakeOverMeasures& measures) {
  const PairMetrics pair = judged.pair.Result();
  measures.min_ttc_s = pair.min_ttc_s;
  measures.min_time_gap_s = pair.min_time_gap_s;
  if (judged.jerk_unknown) measures.max_abs_jerk_1s_mps3.reset();
  measures.mean_deceleration_mps2 = judged.deceleration_mps2.Value();
  measures.automation_drove_s = Seconds(judged.automation_us);
  measures.sensor_excluded_s = Seconds(judged.excluded_us);
  measures.driver_drove_s = Seconds(judged.driver_us);
  measures.manoeuvre_drove_s = Seconds(judged.manoeuvre_us);
}

std::vector<TakeOverMeasures> TakeOverAccumulator::Result() const {
  std::vector<TakeOverMeasures> result = requests_;
  if (judged_) Finish(*judged_, result.back());
  return result;
}

void TakeOverAccumulator::CutOff(std::vector<TakeOverMeasures>& requests) const {
  if (!judged_) return;
  TakeOverMeasures& cut = requests.back();
  for (std::optional<double>* measure :
       {&cut.judged_s, &cut.max_deceleration_mps2, &cut.mean_deceleration_mps2,
        &cut.max_abs_jerk_1s_mps3, &cut.min_ttc_s, &cut.min_time_gap_s, &cut.automation_drove_s,
        &cut.driver_drove_s, &cut.manoeuvre_drove_s, &cut.sensor_excluded_s}) {
    measure->reset();
  }
  const bool may_change =
      cut.outcome == TakeOverEnd::kOpen || cut.outcome == TakeOverEnd::kMinimalRisk;
  if (may_change && !IsLocked(log_.mode())) cut.outcome = TakeOverEnd::kUnknown;
}

}  // namespace fogline::metrics
