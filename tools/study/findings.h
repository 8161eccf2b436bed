// Sentences about comparisons, made from their numbers. What they claim depends on whether an
// interval has 0 in it, and on nothing that is known beforehand.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/comparison.h"

namespace fogline {

/// Whether more of a quantity is better, for sentences that rank.
enum class Better { kMore, kLess };

/// The same difference, seen from the other side.
Estimate Turned(Estimate estimate);

/// Every variant, in order.
std::vector<std::size_t> AllVariants(const Comparison& comparison);

/// Those of `variants` that have no runs which one before them has, measure by measure and seed by
/// seed. Two rules that decide alike are no rivals: they are ranked once.
std::vector<std::size_t> Distinct(const Comparison& comparison, std::size_t test_case,
                                  std::span<const std::size_t> variants);

/// "Blend and bayes have the same runs as traded, in every measure and with every seed. ..."; ""
/// where no two variants do.
std::string SameRunsText(const Comparison& comparison, std::size_t test_case);

/// "Safety improvement (SI), best first: isolate 99.1 [98.9, 99.3], traded ...".
std::string RankingText(const Comparison& comparison, std::size_t test_case,
                        std::string_view measure, int decimals, Better better);

/// "12.3 [11.0, 13.6] points more than before", "0.1 [-0.2, 0.4] points more than before, which is
/// no difference that 300 pairs of runs can tell", "..., with too few runs for an interval". @param
/// than such as " than before", or ""
std::string DifferenceText(const Estimate& difference, std::string_view unit, int decimals,
                           std::string_view than = "");

/// With a capital letter.
std::string Capital(std::string text);

/// "a, b and c".
std::string ListText(const std::vector<std::string>& names);

/// `variants` by what they do to a measure against variant `reference`: "less for a (by ...); more
/// for b (by ...); not to be told apart for c; too few runs for an interval for d". Those with the
/// runs of the reference are not among them.
std::string AgainstText(const Comparison& comparison, std::size_t test_case,
                        const std::vector<std::size_t>& variants, std::size_t reference,
                        std::string_view measure, std::string_view unit, int decimals);

/// Collisions of every variant; "No car collides in any run." where none does.
std::string CollisionText(const Comparison& comparison, std::size_t test_case);

}  // namespace fogline
