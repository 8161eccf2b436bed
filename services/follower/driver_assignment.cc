#include "services/follower/driver_assignment.h"

namespace fogline::follower {

DriverAssignment AssignmentOf(const Scenario& scenario, std::size_t car) {
  const FollowersSection& followers = scenario.followers;
  FollowerCar setting{.driver = followers.driver, .style = followers.style};
  if (car < followers.cars.size()) setting = followers.cars[car];

  const Random random(scenario.seed, Stream::kStyle);
  const auto number = static_cast<std::int64_t>(car);
  DriverAssignment assignment;
  assignment.has_acc = setting.driver == FollowerDriver::kAcc ||
                       (setting.driver == FollowerDriver::kDrawn &&
                        models::DrawChance(followers.acc_share, random, number));
  switch (setting.style) {
    case FollowerStyle::kAggressive:
      assignment.style = models::Style::kAggressive;
      break;
    case FollowerStyle::kNormal:
      assignment.style = models::Style::kNormal;
      break;
    case FollowerStyle::kCautious:
      assignment.style = models::Style::kCautious;
      break;
    case FollowerStyle::kDrawn:
      assignment.style = models::DrawStyle({.aggressive = followers.aggressive_share,
                                            .normal = followers.normal_share,
                                            .cautious = followers.cautious_share},
                                           random, number);
      break;
  }
  return assignment;
}

}  // namespace fogline::follower
