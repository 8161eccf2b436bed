// The cases, variants and claims of the studies. Study `ensemble` examines the claims with other
// parameters.
#pragma once

#include <vector>

#include "scenario/sections/scenario.h"
#include "tools/study/claims.h"
#include "tools/study/comparison.h"

namespace fogline::study {

/// The cases and variants of a study, and the study's claims on the runs of these cases and
/// variants. Claims on other runs, such as runs of strings of cars, are not included.
struct StudyDesign {
  std::vector<StudyCase> cases;
  std::vector<StudyVariant> variants;
  std::vector<PlannedClaim> claims;
};

/// @param paper the scenario of paper.json. The cases with a calibrated radar need the radar's
/// offset in this scenario.
StudyDesign PolicyDesign(const Scenario& paper);
StudyDesign TakeOverDesign();
StudyDesign TransferDesign();
StudyDesign DriverDesign();
StudyDesign FollowersDesign();
StudyDesign VehicleDesign();

}  // namespace fogline::study
