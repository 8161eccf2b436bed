#include "services/follower/person.h"

#include <algorithm>

namespace fogline::follower {
namespace {

std::optional<models::SafetyResponse> ResponseOf(SafetyModelChoice choice, double step_s) {
  switch (choice) {
    case SafetyModelChoice::kNone:
      break;
    case SafetyModelChoice::kReferenceHuman:
      return models::SafetyResponse(models::SafetyModel::kReferenceHuman, step_s);
    case SafetyModelChoice::kRss:
      return models::SafetyResponse(models::SafetyModel::kRss, step_s);
    case SafetyModelChoice::kFuzzy:
      return models::SafetyResponse(models::SafetyModel::kFuzzy, step_s);
  }
  return std::nullopt;
}

}  // namespace

Person::Person(models::Style style, const std::optional<models::FogSight>& sight,
               SafetyModelChoice safety, const Random& errors, double step_s,
               const std::optional<models::Aeb>& aeb)
    : idm_(models::ParametersOf(style).driver),
      sight_(sight),
      driver_(models::ParametersOf(style).human, models::Following(FollowingModel::kIdm, idm_),
              errors, step_s),
      safety_(ResponseOf(safety, step_s)),
      aeb_(aeb) {}

DriverAction Person::Step(std::int64_t step, const models::Situation& now, double visibility_m) {
  const models::Situation seen = sight_ ? sight_->Perceive(now, visibility_m) : now;
  double acceleration_mps2 = driver_.Step(step, seen);
  if (safety_) {
    const double braking_mps2 = safety_->Step(seen);
    if (braking_mps2 > 0) acceleration_mps2 = std::min(acceleration_mps2, -braking_mps2);
  }
  if (aeb_) {
    aeb_->Step(seen);
    acceleration_mps2 = aeb_->Applied(acceleration_mps2);
  }
  return {acceleration_mps2, idm_.headway_s * now.speed_mps + idm_.standstill_m};
}

}  // namespace fogline::follower
