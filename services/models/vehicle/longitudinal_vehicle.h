// A car that follows a commanded acceleration as far as engine, brakes, tyres and hills allow.
#pragma once

#include "services/models/vehicle/actuator.h"
#include "services/models/vehicle/grade_profile.h"
#include "services/models/vehicle/motion.h"
#include "services/models/vehicle/pedals.h"
#include "services/models/vehicle/vehicle_parameters.h"

namespace fogline::models {

/// Acceleration of free fall in m/s2 (standard value, ISO 80000-3).
inline constexpr double kGravity_mps2 = 9.80665;

/// Density of air in kg/m3 (ISO 2533: sea level, 15 degrees Celsius).
inline constexpr double kAirDensity_kgpm3 = 1.225;

/// Longitudinal dynamics with slope angle theta(x), tan(theta) = grade:
///
///     m_eff dv/dt = F_t - F_b - 1/2 rho c_d A v^2 - m g c_r cos(theta) - m g sin(theta)
///
/// F_t is the traction, F_b the force of the brakes, rho the density of air, and x the position.
/// VehicleParameters has the other symbols; a_traction and a_brake below are max_traction_mps2 and
/// max_brake_mps2.
///
/// - A controller turns the commanded acceleration a into a force, F = m_eff a + resistances, for
///   the expected speed in the middle of the step. So the car follows a steady command exactly if
///   no limit is reached and the demand is outside the pedals' dead band (pedals.h).
/// - Traction and brake each have delay and lag (actuator.h).
/// - Engine: F_t <= min(m a_traction, P / v). Brakes: F_b <= m a_brake.
/// - Tyres: they transmit the force m dv/dt + drag + slope, which does not contain the rolling
///   resistance and the inertia of the wheels. This force is at least -mu m g cos(theta), and at
///   most mu m g cos(theta) times the driven share.
///
/// Within a step, traction and brakes act with their mean forces, so that v(t) has a closed form
/// (tanh or tan). The slope and the power limit are taken from the middle of the step. The
/// remaining error is of second order in the step. Cars do not roll backwards, because the brakes
/// hold a car at rest.
///
/// Not thread-safe. Only the constructor allocates memory.
class LongitudinalVehicle {
 public:
  /// @param friction mu, above 0 (FrictionOf)
  /// @throw std::invalid_argument if a parameter is outside of its range.
  LongitudinalVehicle(const VehicleParameters& vehicle, double friction, GradeProfile road,
                      double step_s);

  /// Sets pedals, powertrain and brake to the state in which they have settled under this command,
  /// at the position and speed `now`.
  void Begin(const Motion& now, double command_mps2);

  /// Advances by one step of step_s with this command. Returns an acceleration that is constant
  /// over the step, or up to the moment at which the car comes to rest. Advance(now, result,
  /// step_s) then gives the car's motion at the end of the step. If the step is divided into parts
  /// with one call of Advance() each, the motion is the same.
  /// @param now position and speed of the car, as Advance() has computed them
  double Step(double command_mps2, const Motion& now);

  /// Mean forces at the wheels over the last step; traction is limited by the engine's power.
  double traction_n() const { return traction_n_; }
  double brake_n() const { return brake_n_; }
  Pedal pedal() const { return pedals_.pedal(); }

 private:
  struct Slope {
    double sine = 0;
    double cosine = 1;
  };
  struct Forces {
    double traction_n = 0;
    double brake_n = 0;
  };
  Slope SlopeAt(double position_m) const;
  // Position and speed of the car half a step later.
  Motion Middle(const Motion& now, double acceleration_mps2) const;
  // The controller's demand to the pedals for this command, at this position and speed.
  PedalDemand Demand(double command_mps2, const Motion& at);
  double TractionLimit(double speed_mps) const;
  // The acceleration of a step that begins at this speed, with these forces, on this slope.
  double Respond(const Forces& forces, const Slope& slope, double speed_mps) const;
  // Mean acceleration until the end of the step or until rest, under a constant force and drag.
  double MeanAcceleration(double force_n, double mass_kg, double speed_mps) const;

  VehicleParameters vehicle_;
  GradeProfile road_;
  double friction_;
  double step_s_;
  double effective_mass_kg_;
  double drag_nps2pm2_;  // 1/2 rho c_d A
  Pedals pedals_;
  Actuator powertrain_;
  Actuator brake_;
  double traction_n_ = 0;
  double brake_n_ = 0;
  double last_mps2_ = 0;  // result of the last Step(), or command of Begin()
};

}  // namespace fogline::models
