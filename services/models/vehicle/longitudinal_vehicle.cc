#include "services/models/vehicle/longitudinal_vehicle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace fogline::models {
namespace {

void Require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(std::string("vehicle: ") + what);
}

const VehicleParameters& Checked(const VehicleParameters& p) {
  Require(p.mass_kg > 0.0, "mass_kg is not above 0");
  Require(p.rotating_mass_factor >= 1.0, "rotating_mass_factor is below 1");
  Require(p.drag_coefficient >= 0.0, "drag_coefficient is negative");
  Require(p.frontal_area_m2 >= 0.0, "frontal_area_m2 is negative");
  Require(p.rolling_coefficient >= 0.0, "rolling_coefficient is negative");
  Require(p.power_w > 0.0, "power_w is not above 0");
  Require(p.max_traction_mps2 > 0.0, "max_traction_mps2 is not above 0");
  Require(p.driven_weight_share > 0.0 && p.driven_weight_share <= 1.0,
          "driven_weight_share is outside (0, 1]");
  Require(p.max_brake_mps2 > 0.0, "max_brake_mps2 is not above 0");
  Require(p.pedal_dead_band_mps2 >= 0.0, "pedal_dead_band_mps2 is negative");
  return p;
}

}  // namespace

LongitudinalVehicle::LongitudinalVehicle(const VehicleParameters& vehicle, double friction,
                                         GradeProfile road, double step_s)
    : vehicle_(Checked(vehicle)),
      road_(std::move(road)),
      friction_(friction),
      step_s_(step_s),
      effective_mass_kg_(vehicle.rotating_mass_factor * vehicle.mass_kg),
      drag_nps2pm2_(0.5 * kAirDensity_kgpm3 * vehicle.drag_coefficient * vehicle.frontal_area_m2),
      pedals_(vehicle.pedal_dead_band_mps2 * effective_mass_kg_),
      powertrain_(vehicle.powertrain_delay_s, vehicle.powertrain_lag_s, step_s),
      brake_(vehicle.brake_delay_s, vehicle.brake_lag_s, step_s) {
  Require(friction > 0.0, "friction is not above 0");
}

void LongitudinalVehicle::Begin(const Motion& now, double command_mps2) {
  last_mps2_ = command_mps2;
  pedals_.Release();
  const PedalDemand demand = Demand(command_mps2, now);
  powertrain_.Settle(demand.traction_n);
  brake_.Settle(demand.brake_n);
}

double LongitudinalVehicle::Step(double command_mps2, const Motion& now) {
  const PedalDemand demand = Demand(command_mps2, Middle(now, last_mps2_));
  const double mean_traction_n = powertrain_.Step(demand.traction_n);
  brake_n_ = brake_.Step(demand.brake_n);
  const auto respond = [&](const Motion& at) {
    traction_n_ = std::min(mean_traction_n, TractionLimit(at.speed_mps));
    return Respond({.traction_n = traction_n_, .brake_n = brake_n_}, SlopeAt(at.position_m),
                   now.speed_mps);
  };
  // The inner call uses the limits and the slope at the beginning of the step, to find the middle
  // of the step. The outer call uses the limits and the slope in the middle for the whole step.
  last_mps2_ = respond(Middle(now, respond(now)));
  return last_mps2_;
}

Motion LongitudinalVehicle::Middle(const Motion& now, double acceleration_mps2) const {
  const double half_s = 0.5 * step_s_;
  const double speed_mps = std::max(0.0, now.speed_mps + acceleration_mps2 * half_s);
  return {.position_m = now.position_m + 0.5 * (now.speed_mps + speed_mps) * half_s,
          .speed_mps = speed_mps};
}

LongitudinalVehicle::Slope LongitudinalVehicle::SlopeAt(double position_m) const {
  const double grade = road_.GradeAt(position_m);
  const double cosine = 1.0 / std::sqrt(1.0 + grade * grade);
  return {.sine = grade * cosine, .cosine = cosine};
}

PedalDemand LongitudinalVehicle::Demand(double command_mps2, const Motion& at) {
  const Slope slope = SlopeAt(at.position_m);
  const double weight_n = vehicle_.mass_kg * kGravity_mps2;
  const double resistance_n = drag_nps2pm2_ * at.speed_mps * at.speed_mps +
                              weight_n * (vehicle_.rolling_coefficient * slope.cosine + slope.sine);
  PedalDemand demand = pedals_.Split(effective_mass_kg_ * command_mps2 + resistance_n);
  demand.traction_n = std::min(demand.traction_n, TractionLimit(at.speed_mps));
  demand.brake_n = std::min(demand.brake_n, vehicle_.mass_kg * vehicle_.max_brake_mps2);
  return demand;
}

double LongitudinalVehicle::TractionLimit(double speed_mps) const {
  const double strongest_n = vehicle_.mass_kg * vehicle_.max_traction_mps2;
  return strongest_n * speed_mps <= vehicle_.power_w ? strongest_n : vehicle_.power_w / speed_mps;
}

double LongitudinalVehicle::Respond(const Forces& forces, const Slope& slope,
                                    double speed_mps) const {
  const double mass_kg = vehicle_.mass_kg;
  const double weight_n = mass_kg * kGravity_mps2;
  const double down_n = weight_n * slope.sine;
  const double grip_n = friction_ * weight_n * slope.cosine;
  const double rolling_n = vehicle_.rolling_coefficient * weight_n * slope.cosine;
  const double free_mps2 = MeanAcceleration(forces.traction_n - forces.brake_n - rolling_n - down_n,
                                            effective_mass_kg_, speed_mps);
  // If the tyres slip, the inertia of the wheels has no effect on the car, so the mass is m, not
  // m_eff.
  const double sliding_mps2 = MeanAcceleration(-grip_n - down_n, mass_kg, speed_mps);
  const double spinning_mps2 =
      MeanAcceleration(vehicle_.driven_weight_share * grip_n - down_n, mass_kg, speed_mps);
  const double limited_mps2 = std::clamp(free_mps2, sliding_mps2, spinning_mps2);
  return speed_mps > 0.0 ? limited_mps2 : std::max(0.0, limited_mps2);
}

double LongitudinalVehicle::MeanAcceleration(double force_n, double mass_kg,
                                             double speed_mps) const {
  // dv/dt = p - q v^2 has the solution v(t) = (v + p S) / (1 + q v S). With k^2 = |p q|, S(t) is t
  // if p q = 0, tanh(k t)/k if p q > 0, and tan(k t)/k if p q < 0.
  const double p = force_n / mass_kg;
  const double q = drag_nps2pm2_ / mass_kg;
  const double v = speed_mps;
  const double k = std::sqrt(std::abs(p * q));
  if (p < 0.0) {
    const double rest_s = k > 0.0 ? std::atan(k * v / -p) / k : v / -p;
    if (rest_s == 0.0) return p;
    if (rest_s <= step_s_) return -v / rest_s;
  }
  double s = step_s_;
  if (k > 0.0) s = (p > 0.0 ? std::tanh(k * s) : std::tan(k * s)) / k;
  return (p - q * v * v) * s / ((1.0 + q * v * s) * step_s_);
}

}  // namespace fogline::models
