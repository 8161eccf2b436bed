// The section of a scenario for the cars behind the host.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "scenario/sections/aeb.h"
#include "scenario/sections/field.h"
#include "scenario/sections/human.h"

namespace fogline {

enum class FollowerDriver { kAcc, kHuman, kDrawn };
constexpr auto ChoicesOf(FollowerDriver) {
  return std::to_array<Choice>(
      {{"acc", "the paper's: the ACC of section follower, with perfect sensors"},
       {"human", "a human driver of some style (services/models/follower)"},
       {"drawn", "one of the two, drawn by seed; acc_share is the probability of acc"}});
}

enum class FollowerStyle { kAggressive, kNormal, kCautious, kDrawn };
constexpr auto ChoicesOf(FollowerStyle) {
  return std::to_array<Choice>({{"aggressive", "time gap 1.25 s"},
                                {"normal", "time gap 1.45 s"},
                                {"cautious", "time gap 1.75 s"},
                                {"drawn", "one of the three, drawn by seed"}});
}

enum class SafetyModelChoice { kNone, kReferenceHuman, kRss, kFuzzy };
constexpr auto ChoicesOf(SafetyModelChoice) {
  return std::to_array<Choice>({{"none", "nothing beyond the driver's own model"},
                                {"reference_human", "the careful driver of UN R157"},
                                {"rss", "Responsibility-Sensitive Safety"},
                                {"fuzzy", "the fuzzy safety model of UN R157"}});
}

/// Largest number of cars behind the host. The number is limited because TRUTH must fit one
/// datagram.
inline constexpr std::int64_t kMaxFollowers = 32;

/// One following car that differs from the other following cars.
struct FollowerCar {
  FOGLINE_FIELD(FollowerDriver, driver, FollowerDriver::kAcc, "Driver of the car.");
  FOGLINE_FIELD(FollowerStyle, style, FollowerStyle::kNormal,
                "For a human driver: style of driving.");

  bool operator==(const FollowerCar&) const = default;
};

/// The cars behind the host. Each car starts with the speed and the gap of world.follower_*.
struct FollowersSection {
  FOGLINE_FIELD(std::int64_t, count, 1, {1, kMaxFollowers}, "How many cars follow the host.",
                "Sourav & Cheng 2024: 1; with more cars than the upper limit, TRUTH would not fit "
                "one datagram");
  FOGLINE_FIELD(FollowerDriver, driver, FollowerDriver::kAcc, "Drivers of the following cars.");
  FOGLINE_FIELD(double, acc_share, 0.5, {0, 1},
                "For driver drawn: probability that a car has the ACC.",
                "our choice, because equal shares favour neither");
  FOGLINE_FIELD(FollowerStyle, style, FollowerStyle::kNormal,
                "For a human driver: style of driving.");
  FOGLINE_FIELD(
      double, aggressive_share, 1.0, {0.001, 1000},
      "For style drawn: how common style aggressive is, relative to the other two shares.",
      "our choice, because all three should be equally common");
  FOGLINE_FIELD(double, normal_share, 1.0, {0.001, 1000}, "For style drawn, as aggressive_share.",
                "our choice, because all three should be equally common");
  FOGLINE_FIELD(double, cautious_share, 1.0, {0.001, 1000}, "For style drawn, as aggressive_share.",
                "our choice, because all three should be equally common");
  FOGLINE_FIELD(
      Sight, sight, Sight::kPerfect,
      "For human drivers: kind of sight. Sight fog has the parameters of human.fog_sight.");
  FOGLINE_FIELD(SafetyModelChoice, safety_model, SafetyModelChoice::kNone,
                "For human drivers: how they react to danger, in addition to following.");
  FOGLINE_FIELD(AebSection, aeb, {},
                "Emergency braking of the following cars, on what their drivers see.");
  FOGLINE_FIELD(std::vector<FollowerCar>, cars, {}, {0, kMaxFollowers},
                "Drivers of single cars, nearest to the host first. The other cars follow the "
                "fields above. Entries beyond count have no effect.");

  bool operator==(const FollowersSection&) const = default;
};

}  // namespace fogline
