// The main rules of study `threshold` with a perfect and with a fallible human, and with two
// radars.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/study_page.h"
#include "tools/study/claim.h"
#include "tools/study/study.h"
#include "tools/study/thresholds/threshold_mix.h"

namespace fogline::study {

/// The mix of situations with one human and one radar.
struct HumanMix {
  MixedHuman human;
  MixedRadar radar;
  MixedRuns runs;

  /// "perfect human", "fallible human with realistic noise".
  std::string Name() const;
};

/// Number of mixes.
inline constexpr std::int64_t kHumanMixes = 4;

/// Both humans with drawn radars, then both with a realistic one. The units of their progress are
/// the situations. @throws InputError, StudyStopped
std::vector<HumanMix> RunBothHumans(const StudyContext& context);

/// Both humans side by side, with one radar.
report::StudyTable TableOfHumans(std::span<const HumanMix> mixes, MixedRadar radar);
std::string HumansCsv(std::span<const HumanMix> mixes);

/// The claim that one rule has more or less SI than another one, situation by situation. `of` names
/// the mix; "" for that of drawn humans.
Claim RuleClaim(const MixedRuns& runs, std::string_view of, std::string says, std::string_view a,
                std::string_view b, Sign sign, double margin = 0);
/// Index of the rule of this name. @throws std::out_of_range
std::size_t RuleNamed(const MixedRuns& runs, std::string_view name);

}  // namespace fogline::study
