// Parameters of three kinds of car for driving straight ahead, and the friction of their tyres on
// different roads.
#pragma once

#include "scenario/sections/vehicle.h"

namespace fogline::models {

/// Parameters of a vehicle that drives straight ahead. The defaults are the sedan. If no published
/// value was available, the comment says "estimate". An estimate is a usual value of our choice.
struct VehicleParameters {
  /// m in kg, 500 to 60,000. Sedan: estimate, a mid-size car with its driver.
  double mass_kg = 1500.0;

  /// m_eff / m, 1 to 1.5. m_eff is larger than m, because the car also accelerates its rotating
  /// parts. Estimate; 1.03 to 1.1 is usual for cars in the higher gears.
  double rotating_mass_factor = 1.05;

  /// c_d, 0 to 1.5. Sedan: estimate, the middle of 0.28 to 0.32.
  double drag_coefficient = 0.30;

  /// A in m2, 0 to 12. Sedan: estimate.
  double frontal_area_m2 = 2.2;

  /// c_r, 0 to 0.05. Cars: estimate; 0.010 to 0.013 is usual on asphalt.
  double rolling_coefficient = 0.011;

  /// P at the wheels in W, above 0. Sedan: estimate, within 80 to 110 kW.
  double power_w = 100e3;

  /// Strongest traction per mass at low speed in m/s2, above 0. Estimate.
  double max_traction_mps2 = 4.0;

  /// Share of the weight on driven wheels, above 0 and at most 1. Cars: estimate, front drive.
  double driven_weight_share = 0.6;

  /// Strongest force of the brakes per mass in m/s2, above 0. The friction of the road is a
  /// separate limit. Cars: estimate, more than any road allows, so that the tyres are the limit.
  double max_brake_mps2 = 10.5;

  /// Time from the demand to the first change of traction, s, at least 0. Cars: estimate; 0.1 to
  /// 0.3 is usual.
  double powertrain_delay_s = 0.2;

  /// Time constant of traction, s, at least 0. Source: 0.460 in public implementations of Takahama
  /// & Akasaka 2018.
  double powertrain_lag_s = 0.46;

  /// Time from the demand to the first change of braking, s, at least 0. Cars: estimate; 0.05 to
  /// 0.15 is usual.
  double brake_delay_s = 0.1;

  /// Time constant of braking, s, at least 0. Source: 0.193 in public implementations of Takahama &
  /// Akasaka 2018.
  double brake_lag_s = 0.193;

  /// Half the width of the pedals' dead band, as force per m_eff in m/s2, at least 0. While the
  /// demanded force is within this band around 0, the foot does not change pedals (pedals.h).
  /// Estimate: the whole band is 0.1 to 0.2 m/s2 wide.
  double pedal_dead_band_mps2 = 0.1;
};

/// A sedan: all parameters have their defaults.
inline constexpr VehicleParameters kSedan{};

/// A light car. m is the mass of the BMW 320i in the CommonRoad vehicle models (vehicle 2). Above
/// their switching speed of 7.319 m/s, these models limit the power of the acceleration. P is this
/// limit: 1093 kg * 11.5 m/s2 * 7.319 m/s = 92 kW. The other values are estimates.
inline constexpr VehicleParameters kCompact{
    .mass_kg = 1093.0,
    .drag_coefficient = 0.31,
    .frontal_area_m2 = 2.1,
    .rolling_coefficient = 0.011,
    .power_w = 92e3,
};

/// A loaded tractor with semi-trailer. m is the European limit for five axles (Directive 96/53/EC,
/// 40 t). c_d and A: a tractor of Auburn University's GAVLAB in its published parameter files
/// (0.79, 7.80 m2); c_r: 0.0098, from the Peterbilt trucks of the same laboratory. The other values
/// are estimates. The brakes are stronger than the 5.0 m/s2 that UN R13 requires of heavy trucks.
/// The brakes are slow, because they use compressed air.
inline constexpr VehicleParameters kTruck{
    .mass_kg = 40e3,
    .rotating_mass_factor = 1.1,
    .drag_coefficient = 0.79,
    .frontal_area_m2 = 7.80,
    .rolling_coefficient = 0.0098,
    .power_w = 330e3,
    .max_traction_mps2 = 1.2,
    .driven_weight_share = 0.28,
    .max_brake_mps2 = 6.0,
    .powertrain_delay_s = 0.3,
    .powertrain_lag_s = 0.6,
    .brake_delay_s = 0.2,
    .brake_lag_s = 0.3,
};

/// The parameters of this kind of car.
constexpr const VehicleParameters& ParametersOf(CarKind car) {
  switch (car) {
    case CarKind::kCompact:
      return kCompact;
    case CarKind::kTruck:
      return kTruck;
    case CarKind::kSedan:
      break;
  }
  return kSedan;
}

/// mu, the largest tyre force per weight. Estimate: dry 0.9 to 1.0, wet 0.6 to 0.7, ice 0.1 to 0.2
/// are usual for cars.
constexpr double FrictionOf(Surface surface) {
  switch (surface) {
    case Surface::kWet:
      return 0.65;
    case Surface::kIce:
      return 0.15;
    case Surface::kDry:
      break;
  }
  return 0.9;
}

}  // namespace fogline::models
