#include "tools/study/detection/detector_bank.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "services/decision/conflict/one_step/momentary.h"
#include "services/decision/conflict/over_time/nis.h"
#include "services/decision/policies/conflict_inputs.h"

namespace fogline::study {
namespace {

/// Measures whose score is a short formula of the two ranges. The other measures take at least ten
/// times as long, because they add up bins or intervals, or compare three ranges.
constexpr std::array<std::string_view, 11> kQuickMeasures{
    "doc",   "nis", "nis_window", "nis_signed",  "bhattacharyya", "hellinger",
    "cusum", "glr", "sprt",       "lidar_modes", kDistance};

double DistanceOf(const conflict::Disagreement& disagreement) {
  return std::abs(disagreement.difference_m);
}

std::unique_ptr<conflict::ConflictMeasure> MakeDistance(
    const conflict::ConflictParameters& parameters) {
  return std::make_unique<conflict::Momentary<decltype(&DistanceOf)>>(parameters, &DistanceOf);
}

conflict::Evidence EvidenceOfDifference(double difference_m) {
  constexpr double kRange_m = 36;  // about the gap of paper.json
  constexpr double kStd_m = 0.1;
  return {.radar = {.valid = true, .range_m = kRange_m + difference_m, .std_m = kStd_m},
          .lidar = {.valid = true, .range_m = kRange_m, .std_m = kStd_m},
          .prediction = {.valid = true, .range_m = kRange_m, .std_m = kStd_m}};
}

/// Whether the score of a step depends on this step alone. The test: the score must be the same
/// after a conflict of the sensors as after an agreement.
bool IsOfOneStep(const conflict::ConflictMeasureRow& row) {
  constexpr int kSteps = 50;  // more than any window
  constexpr double kConflict_m = 3;
  constexpr double kLast_m = 0.2;
  const conflict::ConflictParameters parameters;
  const auto score_after = [&](double difference_m) {
    const std::unique_ptr<conflict::ConflictMeasure> measure = row.make(parameters);
    for (int i = 0; i < kSteps; ++i) measure->Step(EvidenceOfDifference(difference_m));
    return measure->Step(EvidenceOfDifference(kLast_m));
  };
  return score_after(0) == score_after(kConflict_m);
}

std::vector<Detector> MakeDetectors() {
  std::vector<Detector> detectors;
  const auto rows = ComparedMeasures();
  const auto add = [&](std::size_t measure, std::string_view with, bool window, bool sign) {
    const std::string_view name = rows[measure].name;
    detectors.push_back({.name = fmt::format("{}{}", name, with),
                         .measure = measure,
                         .window = window,
                         .sign = sign,
                         .is_quick = std::ranges::count(kQuickMeasures, name) > 0});
  };
  for (std::size_t m = 0; m < rows.size(); ++m) add(m, "", false, false);
  for (std::size_t m = 0; m < rows.size(); ++m) {
    if (!IsOfOneStep(rows[m])) continue;
    add(m, " + window", true, false);
    add(m, " + sign", false, true);
    add(m, " + window + sign", true, true);
  }
  return detectors;
}

}  // namespace

conflict::ConflictParameters DetectorParameters(const Scenario& scenario) {
  conflict::ConflictParameters parameters = policies::ConflictParametersOf(scenario.arbitrator);
  const double radar_m = scenario.radar.range_std_m;
  const double lidar_m = scenario.lidar.range_std_m;
  const double frame_m = parameters.bin_width_m * parameters.frame_bins;
  parameters.bin_width_m = std::max({radar_m, lidar_m, parameters.smallest_std_m});
  parameters.frame_bins = static_cast<int>(std::lround(frame_m / parameters.bin_width_m));
  parameters.sprt_delta_m = 2 * parameters.cusum_kappa * std::hypot(radar_m, lidar_m);
  return parameters;
}

std::span<const conflict::ConflictMeasureRow> ComparedMeasures() {
  static const std::vector<conflict::ConflictMeasureRow> kRows = [] {
    const auto table = conflict::ConflictMeasures();
    std::vector<conflict::ConflictMeasureRow> rows(table.begin(), table.end());
    rows.push_back({kDistance, "ours", "[0, inf) m", "by rule; skipped: 0", MakeDistance});
    return rows;
  }();
  return kRows;
}

const std::vector<Detector>& Detectors() {
  static const std::vector<Detector> kDetectors = MakeDetectors();
  return kDetectors;
}

std::size_t DetectorNamed(std::string_view name) {
  const auto found = std::ranges::find(Detectors(), name, &Detector::name);
  if (found == Detectors().end()) throw std::out_of_range(fmt::format("no detector {}", name));
  return static_cast<std::size_t>(found - Detectors().begin());
}

std::vector<std::size_t> AllDetectors() {
  std::vector<std::size_t> all;
  for (std::size_t d = 0; d < Detectors().size(); ++d) all.push_back(d);
  return all;
}

std::vector<std::size_t> QuickDetectors() {
  std::vector<std::size_t> quick = AllDetectors();
  std::erase_if(quick, [](std::size_t d) { return !Detectors()[d].is_quick; });
  return quick;
}

std::vector<std::size_t> SlowDetectors() {
  std::vector<std::size_t> slow = AllDetectors();
  std::erase_if(slow, [](std::size_t d) { return Detectors()[d].is_quick; });
  return slow;
}

DetectorBank::DetectorBank(const conflict::ConflictParameters& parameters,
                           std::span<const std::size_t> detectors)
    : source_(parameters),
      measures_(ComparedMeasures().size()),
      of_measures_(ComparedMeasures().size()),
      scores_(detectors.size()) {
  for (const std::size_t d : detectors) {
    const Detector& detector = Detectors()[d];
    std::unique_ptr<conflict::ConflictMeasure>& measure = measures_[detector.measure];
    if (!measure) measure = ComparedMeasures()[detector.measure].make(parameters);
    Member& member = members_.emplace_back(
        Member{.measure = detector.measure, .sign = detector.sign, .window = {}});
    if (detector.window) member.window.emplace(parameters.window_steps);
  }
}

std::span<const double> DetectorBank::Step(const conflict::Evidence& evidence) {
  const std::optional<conflict::Disagreement> disagreement = source_.Next(evidence);
  const double sign = disagreement && disagreement->difference_m < 0 ? -1 : 1;
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    if (measures_[m]) of_measures_[m] = measures_[m]->Step(evidence);
  }
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& member = members_[i];
    double& score = scores_[i];
    score = of_measures_[member.measure] * (member.sign ? sign : 1);
    if (!member.window) continue;
    member.window->Push(score);
    score = conflict::Mean(*member.window);
  }
  return scores_;
}

void DetectorBank::Reset() {
  source_.Reset();
  for (const auto& measure : measures_) {
    if (measure) measure->Reset();
  }
  for (Member& member : members_) {
    if (member.window) member.window->Clear();
  }
}

}  // namespace fogline::study
