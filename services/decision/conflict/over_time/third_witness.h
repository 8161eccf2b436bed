// Measures that find the sensor that is wrong. The values of radar and LiDAR alone cannot show
// which sensor is wrong, so a third value, the witness, is needed. The witness is the filter's
// prediction of the range from all earlier steps.
//
// Without a fault, the radar's range differs from the LiDAR's range by the known offset offset_m.
// All measures here first subtract this offset from the radar's range. Without a prediction there
// is no witness, and the blame of both sensors is 0. The witness depends on earlier values of the
// sensors. After the witness has followed a slowly drifting sensor, the other sensor is blamed.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "services/decision/conflict/conflict_measure.h"
#include "services/decision/conflict/conflict_parameters.h"
#include "services/decision/conflict/one_step/consonant_belief.h"
#include "services/decision/conflict/window.h"

namespace fogline::conflict {

/// The statistic T that compares one sensor with the prediction:
///
///     T = (sum of u_i)/sqrt(n)        u = (z - prediction)/sqrt(s^2 + s_p^2)
///
/// The sum is over the last n residuals u, with n at most blame_window_steps. z is the sensor's
/// range, s its standard deviation, and s_p the standard deviation of the prediction. If n is 1,
/// T^2 is the normalised innovation squared (NIS). An error of the prediction lasts for several
/// steps, so the residuals of these steps are correlated. Therefore T of a long window scatters
/// more than a standard normal number.
class SensorResidual {
 public:
  /// @param nominal_std_m standard deviation to use before the sensor has stated one
  /// @param missing_error_m error of a missing value, if missing values count as conflict
  SensorResidual(const ConflictParameters& parameters, double nominal_std_m,
                 double missing_error_m);

  /// T after this step; 0 if there is no prediction, or no residual in the window. A missing value
  /// repeats the last residual, adds no residual, or counts as conflict; parameters.missing chooses
  /// the rule.
  double Step(const StatedRange& sensor, const StatedRange& prediction, double offset_m);
  void Reset();

 private:
  std::optional<double> Residual(const StatedRange& sensor, const StatedRange& prediction,
                                 double offset_m);

  MissingLidar missing_;
  double missing_error_m_;
  double smallest_std_m_;
  double nominal_std_m_;
  double std_m_;  // last stated standard deviation
  std::optional<double> last_;
  Window residuals_;
};

/// Blame of a sensor = P(chi-square with one degree of freedom < T^2) = erf(abs(T)/sqrt(2)), with T
/// of SensorResidual. This blame is 1 minus the p-value of the test that the sensor has no fault.
/// If the sensor has no fault and T is standard normal, the blame is uniformly distributed over
/// [0, 1].
class NisBlame final : public BlameMeasure {
 public:
  explicit NisBlame(const ConflictParameters& parameters);

  Blame Step(const Evidence& evidence) override;
  void Reset() override;
  /// The larger T^2 of the two sensors in the last step, at least 0. For large T, the blame rounds
  /// to 1, but T^2 still shows differences.
  double largest_square() const { return largest_square_; }

 private:
  double offset_m_;
  SensorResidual radar_;
  SensorResidual lidar_;
  double largest_square_ = 0;
};

/// The larger T^2 of the two sensors (NisBlame), at least 0.
class NisWitness final : public ConflictMeasure {
 public:
  explicit NisWitness(const ConflictParameters& parameters) : blame_(parameters) {}

  double Step(const Evidence& evidence) override;
  void Reset() override { blame_.Reset(); }

 private:
  NisBlame blame_;
};

/// Products c of three consonant beliefs (ConsonantBeliefs::JaccardProduct()). `square` is the
/// product of a belief with itself, which is equal for all beliefs. The other members are the
/// products of the pairs.
struct BeliefProducts {
  double square;
  double radar_lidar;
  double radar_prediction;
  double lidar_prediction;
};

/// Support of a sensor by the two other bodies of evidence: the other sensor and the prediction. A
/// support is at least 0. Its scale does not matter, because BeliefBlame uses only the ratio of two
/// supports.
struct Support {
  double radar;
  double lidar;
};

/// The support is the credibility of Deng et al. 2004: Crd_i = Sup_i / (sum of all Sup). Sup_i is
/// the sum of Sim_ij over the other bodies j. Sim_ij = 1 - d_J/sqrt(c11), with Jousselme's distance
/// d_J between i and j, and c11 = products.square. (sqrt(c11) is the largest d_J of consonant
/// beliefs. Without this divisor disjoint bodies of evidence would still support each other.)
Support DengSupport(const BeliefProducts& products);
/// Murphy 2000 averages the evidence. Here the support of a body is 1 - d_J/sqrt(c11). d_J is the
/// distance of the body from the average of the two other bodies.
Support MurphySupport(const BeliefProducts& products);
/// Deng's support with another similarity: Sim is the cosine of the angle between two bodies of
/// evidence. The bodies are vectors in the metric of Jousselme's distance, and the law of cosines
/// gives the angle. This formula is our interpretation of the published description of Zhang et al.
/// 2014 (vector space, cosine theorem, degree of mutual support, an extension of Deng's rule). The
/// authors' equations were not available.
Support MutualSupport(const BeliefProducts& products);

/// Blame = 1 - support/support0, at least 0. support0 is the support that the sensor would have if
/// all three means were equal and the standard deviations were unchanged. So different standard
/// deviations alone do not cause blame. For a missing value, the rule `hold` gives the last blame,
/// and the rule `skip` gives no blame. The rule `conflict` gives a blame of 1 to each sensor
/// without a value, and 0 to the other sensor.
class BeliefBlame final : public BlameMeasure {
 public:
  using SupportFunction = Support (*)(const BeliefProducts&);

  BeliefBlame(const ConflictParameters& parameters, SupportFunction support);

  Blame Step(const Evidence& evidence) override;
  void Reset() override { last_ = {}; }

 private:
  Blame Judge(const Evidence& evidence) const;
  // Means and standard deviations are in the order radar, LiDAR, prediction.
  BeliefProducts Products(const std::array<double, 3>& means_m,
                          const std::array<double, 3>& stds_m) const;

  ConsonantBeliefs beliefs_;
  SupportFunction support_;
  MissingLidar missing_;
  double offset_m_;
  double smallest_std_m_;
  Blame last_;
};

/// The larger blame of the two sensors, in [0, 1].
class LargestBlame final : public ConflictMeasure {
 public:
  explicit LargestBlame(std::unique_ptr<BlameMeasure> blame) : blame_(std::move(blame)) {}

  double Step(const Evidence& evidence) override;
  void Reset() override { blame_->Reset(); }

 private:
  std::unique_ptr<BlameMeasure> blame_;
};

}  // namespace fogline::conflict
