// The detectors of study `conflict`. Every measure of conflict is a detector. If the score of a
// measure depends only on the present step, its combinations with the window and the sign of the
// Degree of Conflict are detectors, too.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/decision/conflict/conflict_measures.h"
#include "services/decision/conflict/conflict_parameters.h"
#include "services/decision/conflict/disagreement.h"
#include "services/decision/conflict/window.h"

namespace fogline::study {

/// Parameters of the measures in a scenario. The width of bins and the shift of the SPRT depend on
/// the noise of the scenario's sensors, because fixed values would suit only one of the study's
/// noises. The width of bins is the larger standard deviation of the two sensors, but at least
/// ConflictParameters::smallest_std_m. The SPRT tests for the same shift as the CUSUM. This shift
/// is 2 * cusum_kappa standard deviations of the difference of the sensors.
conflict::ConflictParameters DetectorParameters(const Scenario& scenario);

/// The measure abs(d) in m, with d = radar - LiDAR - known mounting offset. Window, known sign and
/// sigmoid turn this measure into the Degree of Conflict.
inline constexpr std::string_view kDistance = "distance";

/// The rows of ConflictMeasures(), then `distance`.
std::span<const conflict::ConflictMeasureRow> ComparedMeasures();

/// A measure. If its score depends only on the present step, it may be combined with the window,
/// the sign, or both.
struct Detector {
  std::string name;         // such as "nis", "nis + window", "nis + sign", "nis + window + sign"
  std::size_t measure = 0;  // index in ComparedMeasures()
  bool window = false;      // averages the score over the window of the Degree of Conflict
  bool sign = false;        // makes the score negative if the LiDAR's range is too long
  bool is_quick = false;    // needs little time, and no prediction of the filter (SensorBench)
};

/// First a detector for each of ComparedMeasures(), in the same order. Then three more detectors
/// for each measure whose score depends only on the present step: the measure with the window, with
/// the sign, and with both.
const std::vector<Detector>& Detectors();
/// Index in Detectors(). @throws std::out_of_range
std::size_t DetectorNamed(std::string_view name);
/// Indices in Detectors(): of all detectors, of the quick detectors, and of the other detectors.
std::vector<std::size_t> AllDetectors();
std::vector<std::size_t> QuickDetectors();
std::vector<std::size_t> SlowDetectors();

/// Computes the scores of some detectors. Only one thread may use a bank.
class DetectorBank {
 public:
  /// @param detectors indices in Detectors()
  DetectorBank(const conflict::ConflictParameters& parameters,
               std::span<const std::size_t> detectors);

  /// The scores of this step, in the order of the detectors. Call Step() once per step.
  std::span<const double> Step(const conflict::Evidence& evidence);
  /// Restores the state that the bank had directly after its construction.
  void Reset();

 private:
  struct Member {
    std::size_t measure;
    bool sign;
    std::optional<conflict::Window> window;
  };

  conflict::DisagreementSource source_;                               // gives the sign
  std::vector<std::unique_ptr<conflict::ConflictMeasure>> measures_;  // null if no member needs it
  std::vector<double> of_measures_;
  std::vector<Member> members_;
  std::vector<double> scores_;
};

}  // namespace fogline::study
