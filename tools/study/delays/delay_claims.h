// The claims of study `conflict` that compare the delays of two detectors. Study `ensemble`
// examines these claims with other parameters.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/claim.h"
#include "tools/study/study.h"

namespace fogline::study {

/// A claim that the delay of detector `a` differs from the delay of detector `b`, with the sign of
/// a - b.
struct DelayStatement {
  std::string_view says;  // without a capital letter at its beginning
  std::string_view a;
  std::string_view b;
  Sign sign = Sign::kLess;
  double margin = 0;              // s
  bool is_by_definition = false;  // follows from the formulas, so the runs only check the code
};
std::span<const DelayStatement> DelayStatements();

/// The sentence of the claim. If `noise` is not the usual noise, the sentence begins with the name
/// of the noise, such as "With realistic noise".
std::string SaysOf(const DelayStatement& statement, std::string_view noise);

/// The claims of DelayStatements(), without the claims that follow from the formulas
/// (`is_by_definition`). The runs use paper.json with `overrides`, with bias fog and the usual
/// noise. Thresholds and means come from RunDelays().
/// @throws InputError, StudyStopped
std::vector<Claim> RunDelayClaims(const StudyContext& context,
                                  const std::vector<std::string>& overrides);

}  // namespace fogline::study
