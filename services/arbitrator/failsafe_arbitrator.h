// The arbitrator in real time. It decides in every step, with the inputs that are available. If all
// inputs are available, the result equals the result of Arbitrator, bit by bit. If inputs are
// missing, the table of failsafe_table.h decides.
#pragma once

#include <optional>

#include "scenario/sections/scenario.h"
#include "services/arbitrator/arbitrator.h"
#include "services/arbitrator/failsafe_table.h"
#include "services/arbitrator/sensor_pairs.h"
#include "services/graph.h"
#include "services/host_modes.h"
#include "services/input_state.h"
#include "services/models/minimal_risk/minimal_risk.h"

namespace fogline::arbitrator {

/// The inputs of the arbitrator that have arrived. The odometry triggers the decision of a step, so
/// `ego` has always arrived.
struct ArbitratorInputs {
  Heard<ego_t> ego;
  Heard<radar_t> radar;
  Heard<lidar_t> lidar;
  Heard<track_t> track;
  Heard<accel_command_t> automation;
  Heard<driver_command_t> driver;
};

class FailsafeArbitrator {
 public:
  explicit FailsafeArbitrator(const Scenario& scenario);

  /// These functions do the same as the functions of Arbitrator with the same names. If
  /// SetOnDemandInput() is not called before a step, the last values apply.
  static bool UsesOnDemandInput(const Scenario& scenario) {
    return Arbitrator::UsesOnDemandInput(scenario);
  }
  void SetOnDemandInput(const truth_t& truth) { arbitrator_.SetOnDemandInput(truth); }

  /// Returns the host's command for the step of `header`. Call Step() once per decision; steps may
  /// be skipped. The result is valid until the next call. In the minimal risk manoeuvre that this
  /// class begins, `mode` is MINIMAL_RISK and both authorities are 0. The conflict is computed from
  /// the last pairs of sensor values, even if these pairs are old.
  const arbitration_t& Step(const header_t& header, const ArbitratorInputs& inputs);

  /// Starts the minimal risk manoeuvre at the next step, independently of the inputs. Call
  /// DemandMinimalRisk() if the vehicle, or an earlier instance of this role, is already in such a
  /// manoeuvre.
  void DemandMinimalRisk() { demanded_ = true; }

  /// Text that describes the fallback (the decision that replaces the regular decision); "" if
  /// there is no fallback.
  std::string_view fallback() const { return FallbackText(decision_); }
  /// status_t::HOST in two cases: the host is in a minimal risk manoeuvre that lasts until the end
  /// of the run, or the host stands after a manoeuvre until the end of the run. Otherwise 0.
  std::int8_t minimal_risk() const { return IsLocked(out_.mode) ? status_t::HOST : std::int8_t{0}; }
  /// The decision of the last step.
  Decision decision() const { return decision_; }

 private:
  Offer HumanOffer(std::int64_t step, const ArbitratorInputs& inputs) const;
  void Regular(const ArbitratorInputs& inputs, Offer automation);
  Decision Judge(std::int64_t step, const ArbitratorInputs& inputs, InputState pairs) const;
  void Drive(std::int8_t mode, double acceleration_mps2);
  void Stop(const ego_t& ego);

  Arbitrator arbitrator_;
  SensorPairs pairs_;
  models::MinimalRisk minimal_risk_;
  bool person_;  // whether a person drives
  bool person_came_ = false;
  std::int64_t person_due_step_;  // a person who has not come by this step counts as gone
  bool demanded_ = false;
  Decision decision_ = Decision::kHold;
  // Acceleration and mode of the last decision, before emergency braking.
  std::optional<double> last_mps2_;
  std::int8_t last_mode_ = arbitration_t::AUTOMATION;
  arbitration_t out_{};
};

}  // namespace fogline::arbitrator
