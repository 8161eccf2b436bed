// A car that obeys an acceleration as well as engine, brakes, tyres and hills let it.
#pragma once

#include "services/vehicle/actuator.h"
#include "services/vehicle/grade_profile.h"
#include "services/vehicle/parameters.h"
#include "services/vehicle/pedals.h"
#include "services/world/motion.h"

namespace fogline {

/// Acceleration of free fall in m/s2 (standard value, ISO 80000-3).
inline constexpr double kGravity_mps2 = 9.80665;

/// Density of air in kg/m3 (ISO 2533: sea level, 15 degrees Celsius).
inline constexpr double kAirDensity_kgpm3 = 1.225;

/// Longitudinal dynamics with slope angle theta(x), tan(theta) = grade:
///
///     m_eff dv/dt = F_t - F_b - 1/2 rho c_d A v^2 - m g c_r cos(theta) - m g sin(theta)
///
/// - A controller turns the commanded acceleration a into a force, F = m_eff a + resistances, for
///   the speed that the command leads to in the middle of the step. So a steady command is followed
///   exactly where nothing limits it, outside the pedals' dead band (pedals.h).
/// - Traction and brake each come with delay and lag (actuator.h).
/// - Engine: F_t <= min(m a_traction, P / v). Brakes: F_b <= m a_brake.
/// - Tyres: what they transmit is m dv/dt + drag + slope, without the rolling resistance and the
///   wheels' own inertia; it is at least -mu m g cos(theta) and at most that times the driven
///   share.
///
/// Within a step the mean forces act, so that v(t) has a closed form (tanh or tan); slope and power
/// limit are those of the middle of the step. What this leaves is an error of second order in the
/// step. Cars do not roll backwards: at rest the brakes hold against what pulls back.
///
/// Not thread-safe. Allocates nothing but in its constructor.
class LongitudinalVehicle {
 public:
  /// @param friction mu, above 0 (FrictionOf)
  /// @throw std::invalid_argument if a parameter is outside of its range.
  LongitudinalVehicle(const VehicleParameters& vehicle, double friction, GradeProfile road,
                      double step_s);

  /// As if it had driven for long at this speed with this acceleration commanded.
  void Begin(const Motion& now, double command_mps2);

  /// Goes on by one step of step_s with this command. Returns the acceleration for
  /// Advance(now, result, step_s), whose end is the car's: constant over the step, or up to the
  /// moment at which the car comes to rest. Advance() may go there in any number of substeps.
  /// @param now where the car is and how fast, as Advance() left it
  double Step(double command_mps2, const Motion& now);

  /// Mean over the last step, at the wheels, as far as the engine's power allowed.
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
  // Where the car will be, and how fast, half a step on.
  Motion Middle(const Motion& now, double acceleration_mps2) const;
  // What the controller asks of the pedals for this command there.
  PedalDemand Demand(double command_mps2, const Motion& at);
  double TractionLimit(double speed_mps) const;
  // The acceleration of a step that begins at this speed, under these forces on this slope.
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
  double last_mps2_ = 0;  // what the last step returned
};

}  // namespace fogline
