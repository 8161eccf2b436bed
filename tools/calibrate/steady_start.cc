#include "tools/calibrate/steady_start.h"

#include <cmath>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "scenario/sections/field_view.h"
#include "services/models/driver/idm.h"

namespace fogline::calibrate {
namespace {

[[noreturn]] void RefuseSteady(std::string_view why) {
  throw InputError(fmt::format("error: --steady: {}", why));
}

/// The gap at which the human neither accelerates nor brakes behind a car of equal speed.
double GapOfDriver(const Scenario& scenario) {
  const double v = scenario.world.host_speed_mps;
  const DriverSection& driver = scenario.driver;
  if (scenario.human.following != FollowingModel::kIdm) {
    RefuseSteady("/human/following is not idm, the model whose equilibrium is known");
  }
  if (v >= driver.desired_speed_mps) {
    RefuseSteady("/driver/desired_speed_mps is not above /world/host_speed_mps");
  }
  const double free_road = 1 - std::pow(v / driver.desired_speed_mps, driver.exponent);
  return models::Idm(driver).DesiredGap(v, v) / std::sqrt(free_road);
}

double Rounded(double metres) {
  constexpr double kPerMetre = 1e4;
  return std::round(metres * kPerMetre) / kPerMetre;
}

}  // namespace

double TrackOffset(const Scenario& scenario) {
  const FusionSection& filter = scenario.fusion;
  const double radar = 1 / (filter.radar_range_std_m * filter.radar_range_std_m);
  const double lidar = 1 / (filter.lidar_range_std_m * filter.lidar_range_std_m);
  return (radar * scenario.radar.bias_m + lidar * scenario.lidar.bias_m) / (radar + lidar);
}

std::vector<DerivedField> StartSteadily(Scenario& scenario) {
  const double v = scenario.world.host_speed_mps;
  if (scenario.lead.speed_mps != v || scenario.world.follower_speed_mps != v) {
    RefuseSteady("the cars differ in speed at step 0");
  }
  const double gap = GapOfDriver(scenario);
  const double standstill = gap + TrackOffset(scenario) - scenario.acc.headway_s * v;
  const double behind = scenario.follower.standstill_m + scenario.follower.headway_s * v;
  std::vector<DerivedField> derived{
      {kSteadyFields[0], gap}, {kSteadyFields[1], standstill}, {kSteadyFields[2], behind}};
  for (DerivedField& one : derived) {
    one.value = Rounded(one.value);
    const NumberField field = *FieldAt(scenario, one.pointer)->As<NumberField>();
    if (!(one.value >= field.spec.min && one.value <= field.spec.max)) {
      RefuseSteady(fmt::format("{} would be {} m", one.pointer, NumberText(one.value)));
    }
    *field.value = one.value;
  }
  return derived;
}

}  // namespace fogline::calibrate
