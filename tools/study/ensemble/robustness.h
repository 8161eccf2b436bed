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
  std::int64_t times = 1;  // it needs so many times the seeds, because its difference varies much
};

/// A claim with each parameter set.
struct ClaimInSets {
  QuotedClaim quoted;
  std::vector<Claim> sets;  // in the order of the sets
};

/// The verdict on a claim after the runs with one set.
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

/// The part of a finding on which claims bear.
enum class Part {
  kHeading,
  kSide,  // what the text below the heading says
};
/// "heading" or "side claims".
std::string_view Text(Part part);

/// The claims of one part of a finding, and what is known of them.
struct ExaminedPart {
  std::vector<QuotedClaim> claims;
  std::vector<KnownException> exceptions;
  std::string_view why;  // what was found in these sets; ends with a full stop; "" without one
};

/// A finding of docs/findings.md with the claims that decide on it.
struct ExaminedFinding {
  int number = 0;
  std::string_view name;
  ExaminedPart heading;
  ExaminedPart side;

  const ExaminedPart& Of(Part part) const { return part == Part::kHeading ? heading : side; }
};

/// The verdict on several claims in one set: they hold if each of them does. They are opposite if
/// at least one is opposite, and otherwise undecided.
InSet VerdictOn(std::span<const InSet> claims);

/// For each set the verdict on the claims that were judged.
std::vector<InSet> VerdictsOn(std::span<const std::vector<JudgedInSet>> claims);
/// The same as the author found it.
std::vector<InSet> VerdictsOn(const ExaminedPart& examined, std::size_t sets);

/// "set 3", "sets 3 and 7", "sets 3, 5 and 7"; "all eight parameter sets" if these are all.
std::string SetsText(std::span<const int> numbers, std::size_t sets);

/// "holds in sets 1 and 2; opposite in set 3; undecided in set 4. ...": the verdicts as the author
/// found them, and then why. Side claims "hold".
std::string SentenceOf(const ExaminedFinding& finding, Part part, std::size_t sets);

/// The claim that a part of a finding has the verdicts that its author says. Its difference is the
/// least certain one of those that are decided, turned around if it is opposite. If the runs say
/// anything else of any set, this hinders the claim, and the hindrance names claim, set and
/// outcome.
/// @param claims, judged of this part of the finding, in their order
Claim ClaimOnPart(const ExaminedFinding& finding, Part part, std::span<const ClaimInSets> claims,
                  std::span<const std::vector<JudgedInSet>> judged);

}  // namespace fogline::study
