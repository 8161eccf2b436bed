#include "services/follower/driver_assignment.h"

namespace fogline::follower {

DriverAssignment AssignmentOf(const Scenario& scenario, std::size_t car) {
  const FollowersSection& followers = scenario.followers;
  FollowerCar who{.driver = followers.driver, .style = followers.style};
  if (car < followers.cars.size()) who = followers.cars[car];

  const Random random(scenario.seed, Stream::kStyle);
  const auto number = static_cast<std::int64_t>(car);
  DriverAssignment part;
  part.has_acc = who.driver == FollowerDriver::kAcc ||
                 (who.driver == FollowerDriver::kDrawn &&
                  models::DrawChance(followers.acc_share, random, number));
  switch (who.style) {
    case FollowerStyle::kAggressive:
      part.style = models::Style::kAggressive;
      break;
    case FollowerStyle::kNormal:
      part.style = models::Style::kNormal;
      break;
    case FollowerStyle::kCautious:
      part.style = models::Style::kCautious;
      break;
    case FollowerStyle::kDrawn:
      part.style = models::DrawStyle({.aggressive = followers.aggressive_share,
                                      .normal = followers.normal_share,
                                      .cautious = followers.cautious_share},
                                     random, number);
      break;
  }
  return part;
}

}  // namespace fogline::follower
