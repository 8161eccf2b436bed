#include "services/models/follower/safety_response.h"

#include <algorithm>
#include <stdexcept>

namespace fogline::models {
namespace {

// Tolerance for the rounding of sums of steps. With this tolerance, four steps of 0.1 s count as
// 0.4 s.
constexpr double kRounding_s = 1e-9;

}  // namespace

SafetyResponse::SafetyResponse(SafetyModel model, double step_s, const ResponseParameters& response,
                               const RssParameters& rss, const FuzzyParameters& fuzzy)
    : model_(model), step_s_(step_s), response_(response), rss_(rss), fuzzy_(fuzzy) {
  const bool valid =
      step_s > 0.0 && response.perception_s >= 0.0 && response.delay_s >= 0.0 &&
      response.lift_off_mps2 >= 0.0 && response.jerk_mps3 > 0.0 &&
      response.full_braking_mps2 > 0.0 && response.critical_ttc_s >= 0.0 &&
      response.critical_headway_s >= 0.0 && rss.response_s >= 0.0 && rss.acceleration_mps2 >= 0.0 &&
      rss.least_braking_mps2 > 0.0 && rss.most_braking_mps2 > 0.0 && fuzzy.response_s >= 0.0 &&
      fuzzy.comfortable_braking_mps2 > 0.0 &&
      fuzzy.hard_braking_mps2 > fuzzy.comfortable_braking_mps2 && fuzzy.lead_braking_mps2 > 0.0 &&
      fuzzy.standstill_m >= 0.0 && fuzzy.safe_margin_m >= 0.0;
  if (!valid) throw std::invalid_argument("safety response: a parameter is out of its range");
  if (model_ == SafetyModel::kReferenceHuman) return;
  response_.perception_s = model_ == SafetyModel::kRss ? rss.response_s : fuzzy.response_s;
  response_.delay_s = 0.0;
}

double SafetyResponse::Step(const Situation& seen) {
  const double target_mps2 = Target(seen);
  if (target_mps2 == 0.0) {
    alarmed_ = false;
    braking_mps2_ = 0.0;
    return 0.0;
  }
  since_s_ = alarmed_ ? since_s_ + step_s_ : 0.0;
  alarmed_ = true;
  if (since_s_ + kRounding_s < response_.perception_s) return 0.0;
  if (since_s_ + kRounding_s < response_.perception_s + response_.delay_s) {
    braking_mps2_ = response_.lift_off_mps2;
  } else {
    braking_mps2_ = std::min(target_mps2, braking_mps2_ + response_.jerk_mps3 * step_s_);
  }
  return braking_mps2_;
}

double SafetyResponse::Target(const Situation& seen) const {
  if (!seen.ahead) return 0.0;
  switch (model_) {
    case SafetyModel::kReferenceHuman:
      return HumanInDanger(seen) ? response_.full_braking_mps2 : 0.0;
    case SafetyModel::kRss:
      return seen.ahead->gap_m < RssSafeDistance(rss_, seen.speed_mps, seen.ahead->speed_mps)
                 ? response_.full_braking_mps2
                 : 0.0;
    case SafetyModel::kFuzzy:
      break;
  }
  return FuzzyDeceleration(fuzzy_, seen);
}

bool SafetyResponse::HumanInDanger(const Situation& seen) const {
  const CarAhead& ahead = *seen.ahead;
  const double closing_mps = seen.speed_mps - ahead.speed_mps;
  if (alarmed_ && closing_mps > 0.0) return true;
  if (closing_mps > 0.0 && ahead.gap_m < response_.critical_ttc_s * closing_mps) return true;
  return ahead.acceleration_mps2 < -response_.lead_braking_mps2 &&
         ahead.gap_m <= response_.critical_headway_s * seen.speed_mps;
}

}  // namespace fogline::models
