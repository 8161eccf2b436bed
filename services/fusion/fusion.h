// Radar and LiDAR fused into one estimate of the car ahead. Knows the sensors' geometry, and
// nothing of fog: what the LiDAR reports in fog it believes as much as in clear air (unless gating
// is on), which is the weakness that the experiment is about.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "scenario/scenario.h"
#include "services/fusion/ekf.h"
#include "services/fusion/gate.h"
#include "services/graph.h"
#include "services/policies/policy.h"

namespace fogline {

/// Extended Kalman filter (ekf.h) over radar range, radar range rate and LiDAR range, corrected by
/// one value after the other in this order. The state at which a value is predicted contains the
/// values before it; their noises are independent, so without lateral offsets the result is that of
/// a joint correction. Values that are missing or refused by the gate are skipped.
///
/// The noise that it assumes is that of the scenario's section `fusion`. What the sensors state
/// of themselves (range_std_m and its kind) is left alone: a sensor deceived by fog does not know.
///
/// A policy with a say in the fusion (services/policies) judges each step's values against the
/// prediction first. A sensor that it does not trust is compared, and corrects nothing.
class Fusion {
 public:
  explicit Fusion(const Scenario& scenario);

  /// Whether the scenario's policy wants to know the truth: Hear() is then called before every
  /// Step().
  static bool Demands(const Scenario& scenario);
  /// The gap is for the policy alone; nothing else of the truth is looked at.
  void Hear(const truth_t& truth) { true_gap_m_ = truth.host_gap_m; }

  /// The track of this step. Once per step, in order, beginning with the first: `ego` has the
  /// host's acceleration during the step that ended here. The result is valid until the next call.
  const track_t& Step(const ego_t& ego, const radar_t& radar, const lidar_t& lidar);

 private:
  /// Values in order of use; index of track_t's innovation, innovation_variance and usage.
  enum Value : std::size_t { kRadarRange, kRadarRangeRate, kLidarRange, kNumValues };

  /// One measured value against what the estimate says that it should be.
  struct Comparison {
    double measured;
    double predicted;
    Ekf::Jacobian jacobian;
  };

  static std::array<Gate, kNumValues> MakeGates(const FusionSection& section);

  /// Begin the track with this measurement; false if the target is too far to the side for that.
  bool StartFromRadar(const radar_t& radar);
  bool StartFromLidar(const lidar_t& lidar);
  /// What the policy thinks of the values of this step. @pre the filter has predicted
  Trust Judge(const radar_t& radar, const lidar_t& lidar);
  void CorrectByRadar(const radar_t& radar);
  void CorrectByLidar(const lidar_t& lidar);
  void Correct(Value value, const Comparison& comparison);
  /// What becomes of a value, where not every value is used.
  std::int8_t UsageOf(Value value, double normalised_innovation_squared);
  void Record(Value value, double innovation, double variance, std::int8_t usage);
  void Report(double host_acceleration_mps2);

  Ekf ekf_;
  bool gating_;
  std::array<Gate, kNumValues> gates_;
  std::array<double, kNumValues> noise_variance_;
  double radar_offset_m_;
  double lidar_offset_m_;
  double initial_speed_variance_;
  double initial_acceleration_variance_;
  std::unique_ptr<EngagementPolicy> policy_;  // none if it has no say here
  bool selects_ = false;                      // whether gate or policy may refuse a value
  Trust trust_;
  std::optional<double> true_gap_m_;
  bool started_ = false;
  track_t out_{};
};

}  // namespace fogline
