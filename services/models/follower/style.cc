#include "services/models/follower/style.h"

#include <stdexcept>

namespace fogline::models {
namespace {

constexpr double kMpsPerKmph = 1.0 / 3.6;

}  // namespace

StyleParameters ParametersOf(Style style) {
  switch (style) {
    case Style::kAggressive:
      return {.driver = {.max_acceleration_mps2 = 2.0,
                         .comfortable_deceleration_mps2 = 3.0,
                         .desired_speed_mps = 140 * kMpsPerKmph,
                         .headway_s = 1.25,
                         .standstill_m = 1.0},
              .human = {.reaction_time_s = 0.5}};
    case Style::kCautious:
      return {.driver = {.max_acceleration_mps2 = 1.0,
                         .comfortable_deceleration_mps2 = 1.0,
                         .desired_speed_mps = 100 * kMpsPerKmph,
                         .headway_s = 1.75,
                         .standstill_m = 4.0},
              .human = {.reaction_time_s = 1.1}};
    case Style::kNormal:
      break;
  }
  return {.driver = {.max_acceleration_mps2 = 1.4,
                     .comfortable_deceleration_mps2 = 2.0,
                     .desired_speed_mps = 120 * kMpsPerKmph,
                     .headway_s = 1.45,
                     .standstill_m = 2.0},
          .human = {.reaction_time_s = 0.8}};
}

Style DrawStyle(const StyleShares& shares, const Random& random, std::int64_t follower) {
  const double sum = shares.aggressive + shares.normal + shares.cautious;
  const bool valid =
      shares.aggressive >= 0.0 && shares.normal >= 0.0 && shares.cautious >= 0.0 && sum > 0.0;
  if (!valid) throw std::invalid_argument("style: shares are negative or all 0");
  const double drawn = sum * random.Uniform2(follower, 0)[0];
  if (drawn < shares.aggressive) return Style::kAggressive;
  return drawn < shares.aggressive + shares.normal ? Style::kNormal : Style::kCautious;
}

bool DrawChance(double share, const Random& random, std::int64_t follower) {
  return random.Uniform2(follower, 0)[1] < share;
}

}  // namespace fogline::models
