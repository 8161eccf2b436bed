// The section of a scenario for a person who drives the host in place of the model of a driver. Its
// fields describe the map from pedals to an acceleration, the time without input after which the
// person counts as gone (deadman_s), and how the person takes over.
#pragma once

#include <array>
#include <string_view>

#include "scenario/sections/field.h"

namespace fogline {

enum class PedalMap { kLinear, kProgressive };
constexpr auto ChoicesOf(PedalMap) {
  return std::to_array<Choice>(
      {{"linear", "the acceleration is proportional to the pedal's travel"},
       {"progressive",
        "the acceleration is proportional to a power of the pedal's travel (pedal_exponent), so "
        "the first part of the travel is finer"}});
}

enum class TakeOverBy { kButton, kPedal, kEither };
constexpr auto ChoicesOf(TakeOverBy) {
  return std::to_array<Choice>({{"button", "the button for taking over"},
                                {"pedal", "a pedal at take_over_pedal or beyond"},
                                {"either", "the button, or a pedal"}});
}

enum class OverrideBy { kNone, kBrake };
constexpr auto ChoicesOf(OverrideBy) {
  return std::to_array<Choice>(
      {{"none", "the automation drives until it has asked the person"},
       {"brake",
        "a brake at override_pedal or beyond that brakes harder than the car does already takes "
        "over at once (UN R157, 6.3); needs arbitrator.take_over.mode requested"}});
}

enum class WhenGone { kLocked, kUntilBack };
constexpr auto ChoicesOf(WhenGone) {
  return std::to_array<Choice>(
      {{"locked", "the host stops, and stands until the end of the run"},
       {"until_back",
        "the host stops as after a request without an answer: until it stands, a person who is "
        "back "
        "drives on after an answer (take_over_by); needs arbitrator.take_over.mode requested"}});
}

/// A person who drives. services/models/driver/pedal_response.h has the equation of the pedal map.
struct PersonSection {
  FOGLINE_FIELD(bool, drives, false,
                "Whether a person drives, through DRIVER_INPUT. Only a run in real time can have "
                "a person (fogline drive).");
  FOGLINE_FIELD(PedalMap, pedal_map, PedalMap::kProgressive,
                "How a pedal's travel becomes a share of its full effect.");
  FOGLINE_FIELD(double, pedal_exponent, 1.5, {1, 4},
                "For progressive: power of the pedal's travel.",
                "our choice, because half of the travel then gives about a third of the effect");
  FOGLINE_FIELD(double, full_throttle_mps2, 3.0, {0.5, 12, "m/s2"},
                "Acceleration with the throttle pressed fully.",
                "our choice, because a usual car goes from 0 to 100 km/h in about 10 s");
  FOGLINE_FIELD(double, full_brake_mps2, 8.0, {1, 12, "m/s2"},
                "Deceleration with the brake pressed fully.",
                "our choice, because the tyres of cars brake with about 8 m/s2 on a dry road");
  FOGLINE_FIELD(double, coasting_mps2, 0.5, {0, 3, "m/s2"},
                "Deceleration with both pedals released.",
                "our choice, because air, tyres and the drag of the engine slow a car by about "
                "this much at 25 m/s");
  FOGLINE_FIELD(double, deadman_s, 0.3, {0.1, 5, "s"},
                "Without a DRIVER_INPUT for this time, the seat counts as empty: readiness 0, "
                "pedals released.",
                "our choice, because a seat sends at least every 50 ms, so six messages in a row "
                "are then missing");
  FOGLINE_FIELD(WhenGone, when_gone, WhenGone::kLocked,
                "What happens when the seat becomes empty while the person has the authority.");
  FOGLINE_FIELD(TakeOverBy, take_over_by, TakeOverBy::kEither,
                "How the person answers a request to take over.");
  FOGLINE_FIELD(double, take_over_pedal, 0.1, {0.01, 1},
                "For pedal and either: travel of throttle or brake from which on the person takes "
                "over.",
                "our choice, because a foot that rests on a pedal presses less than a tenth");
  FOGLINE_FIELD(OverrideBy, override_by, OverrideBy::kNone,
                "How the person takes over without a request, until they give back.");
  FOGLINE_FIELD(double, override_pedal, 0.1, {0.01, 1},
                "For brake: travel of the brake, with the throttle released, from which on it "
                "overrides.",
                "our choice, because a resting foot presses less, as for take_over_pedal");
  FOGLINE_FIELD(double, key_press_ps, 1.5, {0.1, 20, "1/s"},
                "How fast a pedal moves while its key is down.",
                "our choice, because full brake in 0.7 s still lets a short press brake gently");
  FOGLINE_FIELD(double, key_release_ps, 4.0, {0.1, 20, "1/s"},
                "How fast a pedal moves back when its key is up.",
                "our choice, because a foot leaves a pedal in about a quarter of a second");

  bool operator==(const PersonSection&) const = default;
};

/// Error text for a run that is not in real time although a person drives.
inline constexpr std::string_view kPersonNeedsRealtime =
    "/person/drives: a person drives only in real time, with one process for each role: use "
    "fogline "
    "drive, or fogline run --realtime";

}  // namespace fogline
