// Makes sentences about comparisons from their numbers. A claim depends only on whether an interval
// contains 0, and on no expected result.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/metric_text.h"
#include "tools/study/comparison.h"

namespace fogline::study {

using report::ListText;

/// Whether more of a quantity is better, for sentences that rank.
enum class Better { kMore, kLess };

/// The difference with the opposite sign.
Estimate Turned(Estimate estimate);

/// Every variant, in order.
std::vector<std::size_t> AllVariants(const Comparison& comparison);

/// Those of `variants` whose runs differ from those of all variants before them, in some measure
/// and seed. Two rules that always decide alike are ranked once.
std::vector<std::size_t> Distinct(const Comparison& comparison, std::size_t test_case,
                                  std::span<const std::size_t> variants);

/// "Blend and bayes have the same runs as traded, in every measure and with every seed. ..."; "" if
/// no two variants have the same runs.
std::string SameRunsText(const Comparison& comparison, std::size_t test_case);

/// "Safety improvement (SI), best first: isolate 99.1 [98.9, 99.3], traded ...".
std::string RankingText(const Comparison& comparison, std::size_t test_case,
                        std::string_view measure, int decimals, Better better);

/// "12.3 [11.0, 13.6] points more than before", "0.1 [-0.2, 0.4] points more than before, which is
/// not significant in 300 pairs of runs", "..., with too few runs for an interval".
/// @param than such as " than before", or ""
std::string DifferenceText(const Estimate& difference, std::string_view unit, int decimals,
                           std::string_view than = "");

/// The text with a capital first letter.
std::string Capital(std::string text);

/// Groups `variants` by the difference of a measure from variant `reference`: "less for a (by ...);
/// more for b (by ...); no significant difference for c; too few runs for an interval for d".
/// Variants with the same runs as the reference are left out.
std::string AgainstText(const Comparison& comparison, std::size_t test_case,
                        const std::vector<std::size_t>& variants, std::size_t reference,
                        std::string_view measure, std::string_view unit, int decimals);

/// Collisions of every variant; "No car collides in any run." if there are none.
std::string CollisionText(const Comparison& comparison, std::size_t test_case);

}  // namespace fogline::study
