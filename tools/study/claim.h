// A claim: a statement on which the answer of a study rests. A person writes it. It names a
// difference and its sign, and each run of the study checks it against the numbers (claims.h).
#pragma once

#include <optional>
#include <string>

#include "tools/study/estimate.h"

namespace fogline::study {

/// What a claim says of a difference.
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
  double margin = 0;        // for kEqual: the largest difference that does not matter
  std::optional<double> p;  // of a test for the sign that needs no interval, such as McNemar's
  std::string hindrance;    // why the difference proves nothing; "" if it does
};

}  // namespace fogline::study
