// What one variant does against another, case by case. Collisions come first: a run that ends in
// one has no safety left to lose, so that its mean of what was compromised before flatters it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/comparison.h"

namespace fogline {

/// What the runs of a case let us say of a variant against another, in this order.
enum class CaseVerdict {
  kCollidesMore,  // more often than the other, by the exact test of McNemar
  kCollidesLess,
  kCutShort,  // no such difference, but pairs of runs end early: means over time are not compared
  kNothing,   // neither compromises safety in any run
  kReduces,   // mean compromised safety in fog
  kIncreases,
  kUndecided,
  kTooFew,
};
CaseVerdict VerdictOfCase(const Comparison& comparison, std::size_t test_case, std::size_t variant,
                          std::size_t other);

/// How two variants' collisions differ, from the pairs in which one of them collides only (McNemar
/// 1947; exact, 95 %): kMore where `a` collides more often. At least six such pairs decide.
Verdict CompareCollisions(const Comparison& comparison, Cell a, Cell b);

/// The first case that has the same runs with both variants; nullopt where none before it has.
std::optional<std::size_t> SameCase(const Comparison& comparison, std::size_t test_case,
                                    std::size_t variant, std::size_t other);

/// The first case of the same group: what the others of the group are compared with.
std::size_t ReferenceCase(const Comparison& comparison, std::size_t test_case);

/// In which cases a variant collides more than another, or less, and in which it reduces the
/// compromised safety. Cases with the same runs are counted once.
std::string VerdictFinding(const Comparison& comparison, std::size_t variant, std::size_t other);

/// Of a comparison whose variant 0 is without traded control: VerdictFinding() against it, then a
/// sentence for each case, and how far its SI differs from that of the reference case.
std::vector<std::string> CaseFindings(const Comparison& comparison, std::size_t variant);

}  // namespace fogline
