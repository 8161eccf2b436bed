// Decides whether a finding holds with every parameter set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/claim.h"

namespace fogline::study {

/// A claim of equality has two bounds for the difference of two values. A finding may need only one
/// of these bounds.
enum class Bound {
  kBoth,   // the magnitude of the difference is at most the margin
  kBelow,  // the difference is at least -margin
  kAbove,  // the difference is at most +margin
};

/// A claim of another study. The study's name and the claim's text identify the claim.
struct QuotedClaim {
  std::string_view study;
  std::string_view says;
  std::int64_t one_of = 1;  // one in `one_of` seeds is enough, because the difference is large
  Bound bound = Bound::kBoth;
  std::int64_t times = 1;  // factor for the number of seeds; above 1 if the difference varies much
};

/// A claim, with its numbers for each parameter set.
struct ClaimInSets {
  QuotedClaim quoted;
  std::vector<Claim> sets;  // in the order of the sets
};

/// The verdict on a claim after the runs with one set.
enum class InSet {
  kHolds,
  kOpposite,   // the difference has the other sign; for Sign::kEqual: it is beyond the margin
  kUndecided,  // the difference is too small for this number of runs, or runs end early
};
/// "holds", "opposite" or "undecided".
std::string_view Text(InSet outcome);

struct JudgedInSet {
  InSet outcome = InSet::kUndecided;
  double p = 1;       // p-value of the sign that the difference has in the runs
  double p_holm = 1;  // adjusted for all claims in all sets
};

/// Judges every claim in every set at a level of 5 %, after Holm's correction for all claims in all
/// sets together.
/// @return for each claim its outcomes, in the order of the sets
std::vector<std::vector<JudgedInSet>> JudgeInSets(std::span<const ClaimInSets> claims);

/// A claim that does not hold in some parameter sets. The study's author enters it after the runs.
struct KnownException {
  std::string_view says;
  std::vector<int> sets;  // numbers of the sets, from 1
  InSet outcome = InSet::kOpposite;
};

/// A part of a finding. Each part has claims of its own.
enum class Part {
  kHeading,
  kSide,  // the text below the heading
};
/// "heading" or "side claims".
std::string_view Text(Part part);

/// The claims of one part of a finding, and the known exceptions.
struct ExaminedPart {
  std::vector<QuotedClaim> claims;
  std::vector<KnownException> exceptions;
  std::string_view why;  // explains the exceptions, in whole sentences; "" if not needed
};

/// A finding of docs/findings.md with the claims that decide on it.
struct ExaminedFinding {
  int number = 0;
  std::string_view name;
  ExaminedPart heading;
  ExaminedPart side;

  const ExaminedPart& Of(Part part) const { return part == Part::kHeading ? heading : side; }
};

/// The verdict on several claims in one set: `kHolds` if all claims hold, `kOpposite` if at least
/// one claim is opposite, and otherwise `kUndecided`.
InSet VerdictOn(std::span<const InSet> claims);

/// For each set, the verdict that the runs give on these claims.
std::vector<InSet> VerdictsOn(std::span<const std::vector<JudgedInSet>> claims);
/// For each set, the verdict that the study's author states.
std::vector<InSet> VerdictsOn(const ExaminedPart& examined, std::size_t sets);

/// The numbers of some sets as text: "set 3", "sets 3 and 7", "sets 3, 5 and 7"; "all eight
/// parameter sets" if `numbers` has all sets.
std::string SetsText(std::span<const int> numbers, std::size_t sets);

/// A sentence with the verdicts that the author states, and then ExaminedPart::why. An example:
/// "holds in sets 1 and 2; opposite in set 3; undecided in set 4. ...". For side claims the verb is
/// "hold".
std::string SentenceOf(const ExaminedFinding& finding, Part part, std::size_t sets);

/// Makes a claim about one part of a finding. The claim says: the verdicts that the runs give on
/// this part are the verdicts that the author states. The claim has the difference and the sign of
/// the least certain comparison. Comparisons with the outcome kUndecided are left out; of the
/// others, the comparison with the largest p-value is the least certain one. If outcomes in the
/// runs differ from the author's, the claim does not hold. Claim::hindrance then names each such
/// outcome with its claim and its set.
/// @param claims the claims of this part of the finding, in their order
/// @param judged the outcomes of these claims
Claim ClaimOnPart(const ExaminedFinding& finding, Part part, std::span<const ClaimInSets> claims,
                  std::span<const std::vector<JudgedInSet>> judged);

}  // namespace fogline::study
