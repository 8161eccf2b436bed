// A claim: a statement on which the answer of a study is based. A person writes the claim. The
// claim names a difference and its sign. Whenever the study is computed, it checks the claim
// against the numbers (claims.h).
#pragma once

#include <optional>
#include <string>

#include "tools/study/estimate.h"

namespace fogline::study {

/// The sign that a claim states for a difference.
enum class Sign {
  kLess,   // below 0
  kMore,   // above 0
  kEqual,  // no farther from 0 than the claim's margin
};

struct Claim {
  std::string says;      // one sentence
  std::string compared;  // "beam fog: traded against none, mean compromised safety in fog (m)"
  Sign sign = Sign::kLess;
  Estimate difference;
  double margin = 0;        // for kEqual: the largest difference that is too small to matter
  std::optional<double> p;  // p-value of a test without an interval, such as McNemar's
  /// The p-value, if it is already adjusted for all comparisons. nullopt: CheckClaims() adjusts the
  /// p-value by Holm's method.
  std::optional<double> p_holm = std::nullopt;
  std::string hindrance;  // why the difference cannot support the claim; "" if it can
};

}  // namespace fogline::study
