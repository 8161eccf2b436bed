// The section of a scenario for the cars behind the host.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "scenario/sections/field.h"
#include "scenario/sections/human.h"

namespace fogline {

enum class FollowerDriver { kAcc, kHuman, kDrawn };
template <>
struct ChoiceNames<FollowerDriver> {
  static constexpr std::array<std::string_view, 3> kNames{"acc", "human", "drawn"};
  static constexpr std::array<std::string_view, 3> kDocs{
      "the paper's: the ACC of section follower, with perfect sensors",
      "a person of some style (services/models/follower)",
      "one of the two, drawn by seed; acc_share says how often which"};
};

enum class FollowerStyle { kAggressive, kNormal, kCautious, kDrawn };
template <>
struct ChoiceNames<FollowerStyle> {
  static constexpr std::array<std::string_view, 4> kNames{"aggressive", "normal", "cautious",
                                                          "drawn"};
  static constexpr std::array<std::string_view, 4> kDocs{
      "headway 1.25 s", "headway 1.45 s", "headway 1.75 s", "one of the three, drawn by seed"};
};

enum class SafetyModelChoice { kNone, kReferenceHuman, kRss, kFuzzy };
template <>
struct ChoiceNames<SafetyModelChoice> {
  static constexpr std::array<std::string_view, 4> kNames{"none", "reference_human", "rss",
                                                          "fuzzy"};
  static constexpr std::array<std::string_view, 4> kDocs{
      "nothing beyond the driver's own model", "the careful driver of UN R157",
      "Responsibility-Sensitive Safety", "the fuzzy safety model of UN R157"};
};

/// Greatest number of cars behind the host: TRUTH must fit one datagram.
inline constexpr std::int64_t kMaxFollowers = 32;

/// One following car that differs from the other following cars.
struct FollowerCar {
  FollowerDriver driver = FollowerDriver::kAcc;
  FollowerStyle style = FollowerStyle::kNormal;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("driver", self.driver, "Who drives it.");
    visit.Choice("style", self.style, "For a person: of which temper.");
  }
};

/// The cars behind the host. Each starts with the speed and the gap of world.follower_*.
struct FollowersSection {
  std::int64_t count = 1;
  FollowerDriver driver = FollowerDriver::kAcc;
  double acc_share = 0.5;
  FollowerStyle style = FollowerStyle::kNormal;
  double aggressive_share = 1.0;
  double normal_share = 1.0;
  double cautious_share = 1.0;
  Sight sight = Sight::kPerfect;
  SafetyModelChoice safety_model = SafetyModelChoice::kNone;
  std::vector<FollowerCar> cars;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Integer("count", self.count,
                  {.min = 1,
                   .max = kMaxFollowers,
                   .unit = "",
                   .doc = "How many cars follow the host.",
                   .source = "Sourav & Cheng 2024: 1; at most what a datagram of TRUTH holds"});
    visit.Choice("driver", self.driver, "Who drives them.");
    visit.Number("acc_share", self.acc_share,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "For driver drawn: probability that a car has the ACC.",
                  .source = "our choice, because half and half favours neither"});
    visit.Choice("style", self.style, "For a person: of which temper.");
    visit.Number("aggressive_share", self.aggressive_share,
                 {.min = 0.001,
                  .max = 1000,
                  .unit = "",
                  .doc = "For style drawn: how common it is, beside the other two shares.",
                  .source = "our choice, because all three are to be alike"});
    visit.Number("normal_share", self.normal_share,
                 {.min = 0.001,
                  .max = 1000,
                  .unit = "",
                  .doc = "For style drawn, as aggressive_share.",
                  .source = "our choice, because all three are to be alike"});
    visit.Number("cautious_share", self.cautious_share,
                 {.min = 0.001,
                  .max = 1000,
                  .unit = "",
                  .doc = "For style drawn, as aggressive_share.",
                  .source = "our choice, because all three are to be alike"});
    visit.Choice("sight", self.sight,
                 "For people: what they see; with fog, by section human.fog_sight.");
    visit.Choice("safety_model", self.safety_model,
                 "What a following person does in danger, on top of following.");
    visit.List("cars", self.cars,
               {.min_items = 0,
                .max_items = kMaxFollowers,
                .doc = "The first so many cars one by one, nearest to the host first; the others "
                       "are as above. What is beyond count is not there."});
  }
};

}  // namespace fogline
