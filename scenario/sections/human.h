// The section of a scenario for a human driver of the host, with more details than in the paper.
// The section describes how the driver follows and what the driver sees. It also describes how well
// the driver judges distances and speeds, and how aware of the road the driver is.
#pragma once

#include <array>
#include <string_view>

#include "scenario/sections/field.h"

namespace fogline {

enum class FollowingModel { kIdm, kIidm, kAccIdm };
constexpr auto ChoicesOf(FollowingModel) {
  return std::to_array<Choice>(
      {{"idm", "the paper's (Treiber, Hennecke & Helbing 2000)"},
       {"iidm", "Improved IDM: keeps exactly its time gap (Treiber & Kesting 2013)"},
       {"acc_idm", "IIDM that does not panic at a cut-in (Kesting, Treiber & Helbing 2010)"}});
}

enum class Sight { kPerfect, kFog };
constexpr auto ChoicesOf(Sight) {
  return std::to_array<Choice>(
      {{"perfect", "the paper's: the true gap and speed, in fog as in clear air"},
       {"fog",
        "outline and lamps, as far as they are visible in fog "
        "(services/models/driver/fog_sight.h)"}});
}

/// Sight of a human in fog.
struct FogSightParameters {
  FOGLINE_FIELD(double, contrast, 0.5, {0.2, 1},
                "C_0, contrast of the car ahead against the fog from nearby; 1 is black.",
                "our choice, because a grey car has about half the contrast of a black one");
  FOGLINE_FIELD(double, contrast_threshold, 0.05, {0.001, 0.19},
                "eps, the smallest visible contrast.", "WMO-No. 8, definition of visibility: 0.05");
  FOGLINE_FIELD(double, clear_share, 0.5, {0, 1},
                "Share of the outline's range up to which the driver judges distances correctly.",
                "our choice, because a clear outline needs a contrast of 0.1 to 0.2");
  FOGLINE_FIELD(double, lamp_distance_factor, 1.45, {1, 3},
                "kappa, ratio of perceived to true distance if only the lamps are visible.",
                "Cavallo et al. 2001: 30 to 60 % too far; here the middle");
  FOGLINE_FIELD(double, lamp_intensity_cd, 5.0, {0.1, 1000, "cd"}, "Intensity of the lamps ahead.",
                "tail lamp 5, rear fog lamp 150 to 300 (UN R7, R38)");
  FOGLINE_FIELD(double, illuminance_threshold_lx, 1e-4, {1e-8, 1, "lx"},
                "E_t, the smallest visible illuminance at the eye.",
                "our choice, because 1e-4 to 1e-3 are visible at dusk and by day, 1e-6 by night");
  FOGLINE_FIELD(double, angular_rate_threshold_radps, 0.003, {0, 0.1, "rad/s"},
                "Smallest angular rate that the driver sees as closing in or falling back.",
                "Hoffmann & Mortimer 1996: 0.003");
  FOGLINE_FIELD(double, body_width_m, 1.8, {0.5, 5, "m"}, "Width of the car ahead.",
                "our choice, because usual cars are about 1.8 m wide");
  FOGLINE_FIELD(double, lamp_separation_m, 1.3, {0.3, 5, "m"},
                "Distance between the lamps of the car ahead.",
                "our choice, because the lamps of usual cars are 1.2 to 1.4 m apart");

  bool operator==(const FogSightParameters&) const = default;
};

/// Parameters of the Human Driver Model: errors that change slowly, reaction time, and
/// anticipation.
struct HumanParameters {
  FOGLINE_FIELD(double, reaction_time_s, 0.8, {0, 3, "s"}, "Reaction time T_r, at most 254 steps.",
                "Treiber, Kesting & Helbing 2006 study 0.5 to 1.1; here the middle");
  FOGLINE_FIELD(double, gap_error, 0.05, {0, 1}, "V_s, relative standard deviation of the gap.",
                "Treiber, Kesting & Helbing 2006: 0.05");
  FOGLINE_FIELD(double, approach_error_ps, 0.01, {0, 1, "1/s"},
                "r_c, standard deviation of the inverse time to collision.",
                "Treiber, Kesting & Helbing 2006: 0.01");
  FOGLINE_FIELD(double, error_time_s, 20.0, {0.01, 1000, "s"}, "Correlation time of both errors.",
                "Treiber, Kesting & Helbing 2006: 20");
  FOGLINE_FIELD(
      bool, anticipates, true,
      "The driver anticipates the traffic. This compensates for the driver's reaction time.");

  bool operator==(const HumanParameters&) const = default;
};

/// How much of the road a driver is aware of, and how this awareness fades and returns.
struct AwarenessParameters {
  FOGLINE_FIELD(double, monitoring, 0.5, {0, 1},
                "A_mon, which awareness approaches while the driver only monitors.",
                "SUMO's ToC device: 0.5; 0.3 to 0.7, depending on what else the driver does");
  FOGLINE_FIELD(double, fading_s, 60.0, {0.1, 1e4, "s"},
                "Time constant with which awareness approaches A_mon.",
                "our choice, because 30 to 120 s are plausible; no measurement is known");
  FOGLINE_FIELD(double, recovery_ps, 0.1, {0.001, 100, "1/s"},
                "Growth of awareness while the driver drives, is asked to, or is warned.",
                "SUMO's ToC device: 0.1");
  FOGLINE_FIELD(double, reaction_time_s, 0.8, {0, 3, "s"}, "Reaction time of an aware driver.",
                "Treiber, Kesting & Helbing 2006 study 0.5 to 1.1; here the middle");
  FOGLINE_FIELD(double, slow_reaction_time_s, 0.7, {0, 3, "s"},
                "Additional reaction time of a driver without awareness.",
                "our choice, because it nearly doubles the reaction time; no measurement is known");

  bool operator==(const AwarenessParameters&) const = default;
};

/// Parameters of the human driver in addition to the IDM parameters of section driver. The defaults
/// give the paper's driver.
struct HumanSection {
  FOGLINE_FIELD(FollowingModel, following, FollowingModel::kIdm,
                "The driver's car-following model.");
  FOGLINE_FIELD(double, coolness, 0.99, {0, 1},
                "For acc_idm: the coolness factor; 0 gives the IIDM.",
                "Kesting, Treiber & Helbing 2010: 0.99");
  FOGLINE_FIELD(Sight, sight, Sight::kPerfect, "Kind of sight of the driver.");
  FOGLINE_FIELD(
      bool, misjudges, false,
      "The driver errs, reacts late and anticipates: the Human Driver Model of section errors.");
  FOGLINE_FIELD(bool, loses_awareness, false,
                "Awareness falls while the automation drives (section awareness). The driver "
                "reports it as readiness. Less awareness makes the driver's errors larger.");
  FOGLINE_FIELD(FogSightParameters, fog_sight, {}, "Parameters of sight fog.");
  FOGLINE_FIELD(HumanParameters, errors, {}, "Parameters of misjudges.");
  FOGLINE_FIELD(AwarenessParameters, awareness, {}, "Parameters of loses_awareness.");

  bool operator==(const HumanSection&) const = default;
};

}  // namespace fogline
