// Fuses radar and LiDAR into one estimate of the car ahead. The fusion knows the geometry of the
// sensors, but does not know whether there is fog. So the fusion also uses the LiDAR's wrong values
// in fog, if its gate does not refuse them. The experiment studies this weakness.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "scenario/sections/scenario.h"
#include "services/decision/policies/policy.h"
#include "services/fusion/adaptive_noise.h"
#include "services/fusion/ekf.h"
#include "services/fusion/gate.h"
#include "services/graph.h"

namespace fogline::fusion {

/// Extended Kalman filter (ekf.h) over radar range, radar range rate and LiDAR range. One value
/// after another corrects the filter, in this order. Each value is compared with the state that the
/// values before it have corrected. The noises of the values are independent. So without lateral
/// offsets, the result equals the result of a joint correction. Missing values and values that the
/// gate refuses are skipped.
///
/// The scenario's section `fusion` gives the assumed noise. The filter does not use the standard
/// deviations that the sensors state (such as range_std_m), because a sensor does not know when fog
/// makes its value wrong. With fusion.adaptive_noise, the filter itself estimates the noise of each
/// value from the corrections by this value (adaptive_noise.h).
///
/// Some policies select sensors (services/decision/policies). Before the first correction of a
/// step, such a policy receives the values of the step and the prediction, and makes its selection.
/// The values of a sensor that the policy does not select are compared with the prediction, but do
/// not correct the filter.
class Fusion {
 public:
  explicit Fusion(const Scenario& scenario);

  /// Whether the scenario's policy needs the truth. If the policy needs it, SetOnDemandInput() is
  /// called before every Step().
  static bool UsesOnDemandInput(const Scenario& scenario);
  /// Whether the copies of an object share a part of their state. They share the policy if it
  /// selects sensors.
  static bool CopiesShareState(const Scenario& scenario);
  /// Takes only the gap from the truth. Only the policy uses this gap.
  void SetOnDemandInput(const truth_t& truth) { true_gap_m_ = truth.host_gap_m; }

  /// The track of this step. Call Step() once per step, in the order of steps. In real time, steps
  /// may be left out. `ego` has the host's acceleration from the previous step to this step. The
  /// result is valid until the next call.
  const track_t& Step(const ego_t& ego, const radar_t& radar, const lidar_t& lidar);

 private:
  /// The measured values, in the order in which they correct the filter. Each constant is the index
  /// of its value in track_t's innovation, innovation_variance and usage.
  enum Value : std::size_t { kRadarRange, kRadarRangeRate, kLidarRange, kNumValues };

  /// The prediction of a measured value from the present estimate.
  struct Expectation {
    double value;
    Ekf::Jacobian jacobian;
  };

  static std::array<Gate, kNumValues> MakeGates(const FusionSection& section);
  static std::array<AdaptiveNoise, kNumValues> MakeNoises(const FusionSection& section);

  /// Predicts the track from the step of the last call to this step.
  void Predict(const ego_t& ego);
  /// Begins the track, if a selected sensor has a value.
  void Start(const radar_t& radar, const lidar_t& lidar);
  /// Begin the track with this measurement; return false if the target is too far to the side.
  bool StartFromRadar(const radar_t& radar);
  bool StartFromLidar(const lidar_t& lidar);
  /// The policy's selection of sensors in this step. @pre the filter has predicted
  policies::SensorSelection Judge(const radar_t& radar, const lidar_t& lidar);
  void CorrectByRadar(const radar_t& radar);
  void CorrectByLidar(const lidar_t& lidar);
  Expectation Expect(Value value) const;
  void Correct(Value value, double measured);
  /// The usage of a value (see track_t). UsageOf() is called only if gate or policy may refuse
  /// values.
  std::int8_t UsageOf(Value value, double normalised_innovation_squared);
  void Record(Value value, double innovation, double variance, std::int8_t usage);
  void Report(double host_acceleration_mps2);

  double step_s_;
  Ekf ekf_;
  bool gating_;
  std::array<Gate, kNumValues> gates_;
  bool adapts_;  // whether the filter estimates the noise
  std::array<AdaptiveNoise, kNumValues> noises_;
  double radar_offset_m_;
  double lidar_offset_m_;
  double initial_speed_variance_;
  double initial_acceleration_variance_;
  std::shared_ptr<policies::EngagementPolicy>
      policy_;            // null if the policy does not select sensors; shared with copies
  bool selects_ = false;  // whether gate or policy may refuse a value
  policies::SensorSelection selection_;
  std::optional<double> true_gap_m_;
  bool started_ = false;
  std::int64_t last_step_ = 0;  // step of the last call, and the host's speed in it
  double last_speed_mps_ = 0;
  track_t out_{};
};

}  // namespace fogline::fusion
