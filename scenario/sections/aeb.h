// The section of a scenario for the advanced emergency braking (AEB) of the host, or of a following
// car.
#pragma once

#include <array>
#include <string_view>

#include "scenario/sections/field.h"

namespace fogline {

enum class AebTrigger { kTtc, kDeceleration, kEither, kBoth };
constexpr auto ChoicesOf(AebTrigger) {
  return std::to_array<Choice>(
      {{"ttc", "the time to collision is at most ttc_s"},
       {"deceleration", "the braking that still avoids the collision is at least required_mps2"},
       {"either", "one of the two"},
       {"both", "both at once"}});
}

/// Advanced emergency braking (AEB) after UN Regulation No. 152 (services/models/aeb).
struct AebSection {
  FOGLINE_FIELD(bool, enabled, false, "Whether the car has emergency braking.");
  FOGLINE_FIELD(AebTrigger, trigger, AebTrigger::kTtc, "When a collision counts as imminent.");
  FOGLINE_FIELD(double, ttc_s, 1.0, {0.1, 10, "s"},
                "Time to collision at which the car brakes: gap over closing speed.",
                "our choice, because UN R152 prescribes none; with the default braking it keeps "
                "the impact speeds that 5.2.1.4 allows, with 0.9 s a sedan only just keeps them");
  FOGLINE_FIELD(double, required_mps2, 5.0, {0.1, 12, "m/s2"},
                "Required deceleration (closing speed squared over twice the gap) from which on "
                "the car brakes.",
                "UN R152, 5.2.1.2: 5.0, the least demand of an emergency braking");
  FOGLINE_FIELD(double, deceleration_mps2, 9.0, {5, 12, "m/s2"},
                "Deceleration demand. If the side that drives brakes harder, its braking counts.",
                "our choice, because tyres have a friction of 0.9 to 1.0 on a dry road; UN R152, "
                "5.2.1.2: at least 5.0");
  FOGLINE_FIELD(double, warning_s, 0.8, {0.8, 10, "s"},
                "Time before the braking at which the warning begins. If the danger appears later, "
                "the warning begins at once.",
                "UN R152, 5.2.1.1: at the latest 0.8 s before the braking");
  FOGLINE_FIELD(double, min_speed_mps, 2.77, {0, 70, "m/s"},
                "Least own speed at which warning and braking begin. Braking that has begun "
                "continues below this speed.",
                "UN R152, 5.2.1.3: active at least from 10 km/h on, 2.78 m/s");
  FOGLINE_FIELD(
      double, max_speed_mps, 70.0, {0, 70, "m/s"},
      "Largest own speed at which warning and braking begin.",
      "our choice, because UN R152, 5.2.1.3, asks for 60 km/h (16.7 m/s) at least, and 70 "
      "m/s is the fastest car of a scenario");
  FOGLINE_FIELD(double, release_closing_mps, 0.0, {0, 20, "m/s"},
                "Warning and braking begin only above this closing speed, and end at it.",
                "our choice, because a car can only run into a slower car");

  bool operator==(const AebSection&) const = default;
};

}  // namespace fogline
