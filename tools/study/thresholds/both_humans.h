// Runs the main rules of study `threshold` with a perfect and with a fallible human, and with two
// radars.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/study_page.h"
#include "tools/study/claim.h"
#include "tools/study/study.h"
#include "tools/study/thresholds/threshold_mix.h"

namespace fogline::study {

/// Runs of the mix of situations (threshold_mix.h) with one human and one radar.
struct HumanMix {
  MixedHuman human;
  MixedRadar radar;
  MixedRuns runs;

  /// Name of the mix, such as "perfect human" or "fallible human with realistic noise".
  std::string Name() const;
};

/// Number of mixes: two humans with two radars each.
inline constexpr std::int64_t kHumanMixes = 4;

/// Runs four mixes: both humans with the radar noise that is drawn at random for each situation,
/// then both humans with a realistic radar. The progress counts the situations of all mixes.
/// @throws InputError, StudyStopped
std::vector<HumanMix> RunBothHumans(const StudyContext& context);

/// A table of the mixes with this radar, with both humans side by side.
report::StudyTable TableOfHumans(std::span<const HumanMix> mixes, MixedRadar radar);
std::string HumansCsv(std::span<const HumanMix> mixes);

/// The claim on the difference in SI (safety improvement) between rule `a` and rule `b`. The values
/// are paired situation by situation. `of` names the mix; "" stands for the mix in which each
/// situation has a random human (MixedHuman::kDrawn).
Claim RuleClaim(const MixedRuns& runs, std::string_view of, std::string says, std::string_view a,
                std::string_view b, Sign sign, double margin = 0);
/// The rules of ClaimsOnFixed().
inline constexpr std::array<std::string_view, 3> kFixedRules{"fixed 0.3", "fixed 0.5",
                                                             "fixed 0.99"};
/// Two claims. A rule that hardly ever hands over (fixed 0.99) is safer than the paper's threshold
/// (fixed 0.5). The paper's threshold is safer than a low threshold (fixed 0.3). `of` has the same
/// meaning as in RuleClaim().
std::vector<Claim> ClaimsOnFixed(const MixedRuns& runs, std::string_view of);
/// Index of the rule with this name. @throws std::out_of_range
std::size_t RuleNamed(const MixedRuns& runs, std::string_view name);

}  // namespace fogline::study
