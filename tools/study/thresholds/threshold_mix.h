// The runs of study `threshold`: rules with a parameter, over a mix of situations.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/comparison.h"
#include "tools/study/estimate.h"
#include "tools/study/study.h"

namespace fogline::study {

/// A rule with a parameter that trades engagement against safety.
struct RuleFamily {
  std::string name;
  std::vector<double> values;  // of its parameter, one for each member
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

/// Runs all situations: one for each seed, the same for every rule. The first family is that of
/// fixed thresholds, in ascending order. @throws InputError, StudyStopped
MixedRuns RunMix(const StudyContext& context);

/// Description of the situations.
std::string MixText();

}  // namespace fogline::study
