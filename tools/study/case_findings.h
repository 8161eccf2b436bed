// Compares one variant with another, case by case. Collisions come first: a run that ends in a
// collision has no safety left to lose, so its mean compromised safety before the collision looks
// too good.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/comparison.h"

namespace fogline::study {

/// Verdict on a variant against another one in a case: the first of these that applies.
enum class CaseVerdict {
  kCollidesMore,  // more often than the other, by the exact test of McNemar
  kCollidesLess,
  kCutShort,  // no such difference, but pairs of runs end early, so means over time are not
              // compared
  kNothing,   // no variant compromises safety in any run
  kReduces,   // the mean compromised safety in fog
  kIncreases,
  kUndecided,
  kTooFew,
};
CaseVerdict VerdictOfCase(const Comparison& comparison, std::size_t test_case, std::size_t variant,
                          std::size_t other);

/// Compares the collisions of two variants by the pairs in which only one of them collides (McNemar
/// 1947; exact, 95 %). kMore means that `a` collides more often. A decision needs at least six such
/// pairs.
Verdict CompareCollisions(const Comparison& comparison, Cell a, Cell b);

/// The first case before this one that has the same runs with both variants; nullopt if there is
/// none.
std::optional<std::size_t> SameCase(const Comparison& comparison, std::size_t test_case,
                                    std::size_t variant, std::size_t other);

/// The first case of the same group, which is the reference for the other cases of the group.
std::size_t ReferenceCase(const Comparison& comparison, std::size_t test_case);

/// Lists the cases in which a variant collides more or less than another one, and those in which it
/// reduces the compromised safety. Cases with the same runs are counted once.
std::string VerdictFinding(const Comparison& comparison, std::size_t variant, std::size_t other);

/// For a comparison whose variant 0 is without traded control: VerdictFinding() against variant 0,
/// then a sentence for each case, with the difference of its SI from that of the reference case.
std::vector<std::string> CaseFindings(const Comparison& comparison, std::size_t variant);

}  // namespace fogline::study
