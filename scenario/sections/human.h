// The section of a scenario for a more detailed human driver of the host than the paper's: how he
// follows, what he sees, how well he judges it, and how much of the road he is aware of.
#pragma once

#include <array>
#include <string_view>

#include "scenario/sections/field.h"

namespace fogline {

enum class FollowingModel { kIdm, kIidm, kAccIdm };
template <>
struct ChoiceNames<FollowingModel> {
  static constexpr std::array<std::string_view, 3> kNames{"idm", "iidm", "acc_idm"};
  static constexpr std::array<std::string_view, 3> kDocs{
      "the paper's (Treiber, Hennecke & Helbing 2000)",
      "Improved IDM: keeps exactly its headway (Treiber & Kesting 2013)",
      "IIDM that does not panic at a cut-in (Kesting, Treiber & Helbing 2010)"};
};

enum class Sight { kPerfect, kFog };
template <>
struct ChoiceNames<Sight> {
  static constexpr std::array<std::string_view, 2> kNames{"perfect", "fog"};
  static constexpr std::array<std::string_view, 2> kDocs{
      "the paper's: the true gap and speed in fog as in clear air",
      "what fog leaves of outline and lamps (services/models/driver/fog_sight.h)"};
};

/// Sight of a human in fog.
struct FogSightParameters {
  double contrast = 0.5;
  double contrast_threshold = 0.05;
  double clear_share = 0.5;
  double lamp_distance_factor = 1.45;
  double lamp_intensity_cd = 5.0;
  double illuminance_threshold_lx = 1e-4;
  double angular_rate_threshold_radps = 0.003;
  double body_width_m = 1.8;
  double lamp_separation_m = 1.3;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number(
        "contrast", self.contrast,
        {.min = 0.2,
         .max = 1,
         .unit = "",
         .doc = "C_0, contrast of the car ahead against the fog from nearby; 1 is black.",
         .source = "our choice, because a grey car has about half the contrast of a black one"});
    visit.Number("contrast_threshold", self.contrast_threshold,
                 {.min = 0.001,
                  .max = 0.19,
                  .unit = "",
                  .doc = "eps, the least contrast that is seen.",
                  .source = "WMO-No. 8, definition of visibility: 0.05"});
    visit.Number("clear_share", self.clear_share,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "Share of the outline's range up to which distances are judged rightly.",
                  .source = "our choice, because a clear outline wants a contrast of 0.1 to 0.2"});
    visit.Number("lamp_distance_factor", self.lamp_distance_factor,
                 {.min = 1,
                  .max = 3,
                  .unit = "",
                  .doc = "kappa, perceived over true distance where only lamps are seen.",
                  .source = "Cavallo et al. 2001: 30 to 60 % too far; the middle"});
    visit.Number("lamp_intensity_cd", self.lamp_intensity_cd,
                 {.min = 0.1,
                  .max = 1000,
                  .unit = "cd",
                  .doc = "Intensity of the lamps ahead.",
                  .source = "tail lamp 5, rear fog lamp 150 to 300 (UN R7, R38)"});
    visit.Number(
        "illuminance_threshold_lx", self.illuminance_threshold_lx,
        {.min = 1e-8,
         .max = 1,
         .unit = "lx",
         .doc = "E_t, least illuminance at the eye that is seen.",
         .source = "our choice, because 1e-4 to 1e-3 are seen at dusk and by day, 1e-6 by night"});
    visit.Number("angular_rate_threshold_radps", self.angular_rate_threshold_radps,
                 {.min = 0,
                  .max = 0.1,
                  .unit = "rad/s",
                  .doc = "Least angular rate that is seen as closing in or falling back.",
                  .source = "Hoffmann & Mortimer 1996: 0.003"});
    visit.Number("body_width_m", self.body_width_m,
                 {.min = 0.5,
                  .max = 5,
                  .unit = "m",
                  .doc = "Width of the car ahead.",
                  .source = "our choice, because usual cars are about so wide"});
    visit.Number("lamp_separation_m", self.lamp_separation_m,
                 {.min = 0.3,
                  .max = 5,
                  .unit = "m",
                  .doc = "Distance between its lamps.",
                  .source = "our choice, because the lamps of usual cars are 1.2 to 1.4 m apart"});
  }
};

/// Human Driver Model: errors with a memory, reaction time, anticipation.
struct HumanParameters {
  double reaction_time_s = 0.8;
  double gap_error = 0.05;
  double approach_error_ps = 0.01;
  double error_time_s = 20.0;
  bool anticipates = true;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("reaction_time_s", self.reaction_time_s,
                 {.min = 0,
                  .max = 3,
                  .unit = "s",
                  .doc = "T_r; at most 254 steps.",
                  .source = "Treiber, Kesting & Helbing 2006 look at 0.5 to 1.1; the middle"});
    visit.Number("gap_error", self.gap_error,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "V_s, relative standard deviation of the gap.",
                  .source = "Treiber, Kesting & Helbing 2006: 0.05"});
    visit.Number("approach_error_ps", self.approach_error_ps,
                 {.min = 0,
                  .max = 1,
                  .unit = "1/s",
                  .doc = "r_c, standard deviation of the inverse time to collision.",
                  .source = "Treiber, Kesting & Helbing 2006: 0.01"});
    visit.Number("error_time_s", self.error_time_s,
                 {.min = 0.01,
                  .max = 1000,
                  .unit = "s",
                  .doc = "Correlation time of both errors.",
                  .source = "Treiber, Kesting & Helbing 2006: 20"});
    visit.Flag("anticipates", self.anticipates, "He makes up for his reaction time.");
  }
};

/// How much of the road a driver is aware of, and how his awareness fades and returns.
struct AwarenessParameters {
  double monitoring = 0.5;
  double fading_s = 60.0;
  double recovery_ps = 0.1;
  double reaction_time_s = 0.8;
  double slow_reaction_time_s = 0.7;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("monitoring", self.monitoring,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "A_mon, where awareness ends up while he only monitors.",
                  .source = "SUMO's ToC device: 0.5; 0.3 to 0.7 by what else the driver does"});
    visit.Number(
        "fading_s", self.fading_s,
        {.min = 0.1,
         .max = 1e4,
         .unit = "s",
         .doc = "Time constant of the way there.",
         .source = "our choice, because 30 to 120 s are plausible; nothing measured is at hand"});
    visit.Number("recovery_ps", self.recovery_ps,
                 {.min = 0.001,
                  .max = 100,
                  .unit = "1/s",
                  .doc = "Growth while he drives or is asked to.",
                  .source = "SUMO's ToC device: 0.1"});
    visit.Number("reaction_time_s", self.reaction_time_s,
                 {.min = 0,
                  .max = 3,
                  .unit = "s",
                  .doc = "Reaction time of an aware driver.",
                  .source = "Treiber, Kesting & Helbing 2006 look at 0.5 to 1.1; the middle"});
    visit.Number("slow_reaction_time_s", self.slow_reaction_time_s,
                 {.min = 0,
                  .max = 3,
                  .unit = "s",
                  .doc = "What a driver without awareness needs more.",
                  .source = "our choice, because it nearly doubles the reaction time; nothing "
                            "measured is at hand"});
  }
};

/// Parameters of the human driver in addition to the IDM parameters of section driver. The defaults
/// give the paper's driver.
struct HumanSection {
  FollowingModel following = FollowingModel::kIdm;
  double coolness = 0.99;
  Sight sight = Sight::kPerfect;
  bool misjudges = false;
  bool loses_awareness = false;
  FogSightParameters fog_sight;
  HumanParameters errors;
  AwarenessParameters awareness;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("following", self.following, "How he follows the car ahead.");
    visit.Number("coolness", self.coolness,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "For acc_idm: 0 is the IIDM.",
                  .source = "Kesting, Treiber & Helbing 2010: 0.99"});
    visit.Choice("sight", self.sight, "What he sees.");
    visit.Flag("misjudges", self.misjudges,
               "He errs, is late and anticipates: the Human Driver Model of section errors.");
    visit.Flag("loses_awareness", self.loses_awareness,
               "His awareness fades while the automation drives (section awareness): it is the "
               "readiness that he reports, and makes his errors larger.");
    visit.Section("fog_sight", self.fog_sight, "For sight fog.");
    visit.Section("errors", self.errors, "For misjudges.");
    visit.Section("awareness", self.awareness, "For loses_awareness.");
  }
};

}  // namespace fogline
