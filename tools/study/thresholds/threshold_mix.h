// The runs of study `threshold`. The study compares rules that decide when the human drives, such
// as a fixed threshold, over a mix of situations.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/comparison.h"
#include "tools/study/estimate.h"
#include "tools/study/study.h"

namespace fogline::study {

/// Rules of one kind, such as all fixed thresholds. A rule has a parameter that trades human
/// engagement against safety. Each member of the family is the rule with one value of the
/// parameter.
struct RuleFamily {
  std::string name;
  std::vector<double> values;  // values of the parameter, one for each member
  std::vector<StudyVariant> members;
};

/// Results of one member over all situations.
struct RuleMember {
  std::size_t family = 0;
  std::string name;
  std::vector<double> si_pct;
  std::vector<double> rhe_pct;
  std::vector<double> shortfall_m;
  std::int64_t collisions = 0;

  double si() const { return EstimateOf(si_pct).mean; }
  double rhe() const { return EstimateOf(rhe_pct).mean; }
};

struct MixedRuns {
  std::vector<RuleFamily> families;
  std::vector<RuleMember> members;  // ordered by family
  std::int64_t situations = 0;
};

/// The human who takes over in the situations.
enum class MixedHuman {
  kDrawn,     // half of the humans judge correctly and stay aware; fog limits the sight of all
  kPerfect,   // the paper's human
  kFallible,  // sees only as far as fog allows, misjudges distances and loses awareness
};
/// The noise of the radar in the situations.
enum class MixedRadar {
  kDrawn,
  kRealistic,  // RealisticNoise()
};

/// All rules. The first family has the fixed thresholds, in ascending order.
std::vector<RuleFamily> RuleFamilies();
/// The rules with these names, grouped by family. Families without any of these rules are left out.
std::vector<RuleFamily> RulesNamed(std::span<const std::string_view> names);

/// Runs all situations. Each seed has one situation, which is the same for every rule, human and
/// radar.
/// @param overrides changes of paper.json, for fields that do not vary between situations
/// @throws InputError, StudyStopped
MixedRuns RunMix(const StudyContext& context, std::vector<RuleFamily> families, MixedHuman human,
                 MixedRadar radar, std::vector<std::string> overrides = {});

/// Description of the situations with drawn humans and radars.
std::string MixText();

}  // namespace fogline::study
