#include "services/follower/person.h"

#include <algorithm>

namespace fogline {
namespace {

std::optional<SafetyResponse> ResponseOf(SafetyModelChoice choice, double step_s) {
  switch (choice) {
    case SafetyModelChoice::kNone:
      break;
    case SafetyModelChoice::kReferenceHuman:
      return SafetyResponse(SafetyModel::kReferenceHuman, step_s);
    case SafetyModelChoice::kRss:
      return SafetyResponse(SafetyModel::kRss, step_s);
    case SafetyModelChoice::kFuzzy:
      return SafetyResponse(SafetyModel::kFuzzy, step_s);
  }
  return std::nullopt;
}

}  // namespace

Person::Person(Style style, const std::optional<FogSight>& sight, SafetyModelChoice safety,
               const Random& errors, double step_s)
    : idm_(ParametersOf(style).driver),
      sight_(sight),
      driver_(ParametersOf(style).human, Following(FollowingModel::kIdm, idm_), errors, step_s),
      safety_(ResponseOf(safety, step_s)) {}

CarDriver::Action Person::Step(std::int64_t step, const Situation& now, double visibility_m) {
  const Situation seen = sight_ ? sight_->Perceive(now, visibility_m) : now;
  double acceleration_mps2 = driver_.Step(step, seen);
  if (safety_) {
    const double braking_mps2 = safety_->Step(seen);
    if (braking_mps2 > 0) acceleration_mps2 = std::min(acceleration_mps2, -braking_mps2);
  }
  return {acceleration_mps2, idm_.headway_s * now.speed_mps + idm_.standstill_m};
}

}  // namespace fogline
