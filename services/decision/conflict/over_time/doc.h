// The paper's Degree of Conflict as a conflict measure.
#pragma once

#include "services/decision/conflict/disagreement.h"
#include "services/decision/conflict/over_time/degree_of_conflict.h"

namespace fogline::conflict {

/// DoC = 1/(1 + exp(-slope (z - centre))), in [0, 1], where z is the windowed conflict (Sourav &
/// Cheng 2024; services/decision/conflict/over_time/degree_of_conflict.h). If z is the mean of
/// absolute differences, the expected z is sqrt(2 S/pi) without a fault and without an offset. S is
/// the variance of the difference (disagreement.h). This measure uses only the difference in
/// metres. All other measures also use the standard deviations of the ranges. The offset of the
/// sensors is not subtracted. A step without a difference (DisagreementSource::Next()) adds an
/// empty entry to the window.
class Doc final : public ConflictMeasure {
 public:
  explicit Doc(const ConflictParameters& parameters);

  double Step(const Evidence& evidence) override;
  void Reset() override;

  /// First half of a Step(): adds the step to the window.
  void Observe(const Evidence& evidence);
  /// The conflict z of the window, in m. The second half of a Step() computes the DoC from z.
  double conflict_m() const { return window_.Conflict(reading_); }

 private:
  DisagreementSource source_;
  ConflictWindow window_;
  ConflictReading reading_;
  double slope_pm_;
  double centre_m_;
};

}  // namespace fogline::conflict
