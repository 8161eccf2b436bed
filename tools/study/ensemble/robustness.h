// Whether a finding holds with every parameter set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/claim.h"

namespace fogline::study {

/// How a finding uses a claim that two things are equal.
enum class Bound {
  kBoth,   // the difference does not matter
  kBelow,  // it is not less than 0 by more than the margin
  kAbove,  // it is not more than 0 by more than the margin
};

/// A claim of another study, by the study's name and the claim's own words.
struct QuotedClaim {
  std::string_view study;
  std::string_view says;
  std::int64_t one_of = 1;  // it needs only one of so many seeds, because its difference is large
  Bound bound = Bound::kBoth;
};

/// A claim with each parameter set.
struct ClaimInSets {
  QuotedClaim quoted;
  std::vector<Claim> sets;  // in the order of the sets
};

/// What the runs with one set say of a claim.
enum class InSet {
  kHolds,
  kOpposite,   // the difference has the other sign; of a claim that two things are equal: they
               // differ
  kUndecided,  // the difference is too small for these runs, or its runs end early
};
/// "holds", "opposite" or "undecided".
std::string_view Text(InSet outcome);

struct JudgedInSet {
  InSet outcome = InSet::kUndecided;
  double p = 1;       // of the sign that the difference has
  double p_holm = 1;  // adjusted for all claims in all sets
};

/// Judges every claim in every set, at 5 % after Holm's correction for all of them together.
/// @return for each claim its outcomes, in the order of the sets
std::vector<std::vector<JudgedInSet>> JudgeInSets(std::span<const ClaimInSets> claims);

/// A claim that does not hold in some sets, as the study's author found it.
struct KnownException {
  std::string_view says;
  std::vector<int> sets;  // numbers from 1
  InSet outcome = InSet::kOpposite;
};

/// A finding of docs/findings.md with the comparisons that decide on it.
struct ExaminedFinding {
  int number = 0;
  std::string_view name;
  std::vector<QuotedClaim> central;
  std::vector<KnownException> exceptions;
  std::string_view why;  // what was found in these sets; ends with a full stop; "" without one
};

/// The numbers of the sets in which any of the claims does not hold, from 1.
std::vector<int> SetsWithout(std::span<const std::vector<JudgedInSet>> claims);
/// The same as its author found it.
std::vector<int> SetsWithout(const ExaminedFinding& finding);

/// "set 3", "sets 3 and 7", "sets 3, 5 and 7".
std::string SetsText(std::span<const int> numbers);

/// "Holds in all eight parameter sets.", "Does not hold in set 3: ...". A finding is robust only if
/// each of its central comparisons holds in all sets.
std::string SentenceOf(const ExaminedFinding& finding, std::size_t sets);

/// The claim that the finding holds in the sets in which its author says that it does, and in no
/// other. Its difference is the least certain one of those that hold. If the runs say anything else
/// of any set, this hinders the claim, and the hindrance names claim, set and outcome.
/// @param claims, judged of the finding's central comparisons, in their order
Claim ClaimOnFinding(const ExaminedFinding& finding, std::span<const ClaimInSets> claims,
                     std::span<const std::vector<JudgedInSet>> judged);

}  // namespace fogline::study
