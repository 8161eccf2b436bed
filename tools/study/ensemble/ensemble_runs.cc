#include "tools/study/ensemble/ensemble_runs.h"

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "tools/stats/mcnemar.h"
#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/design.h"
#include "tools/study/followers/string_runs.h"
#include "tools/study/thresholds/both_humans.h"
#include "tools/study/thresholds/threshold_mix.h"

namespace fogline::study {
namespace {

/// What all runs of this study share.
struct Ensemble {
  const StudyContext& context;
  std::span<const EnsembleSet> sets;
  std::span<const QuotedClaim> quoted;

  std::vector<std::string> Overrides(const EnsembleSet& set, std::string_view file) const {
    return OverridesOf(set, context.scenarios / file);
  }
};

/// The name of a case with a set: "set 3: bias fog".
std::string NameWith(const EnsembleSet& set, std::string_view test_case) {
  return fmt::format("{}: {}", set.name, test_case);
}

/// A case with a set. What the case itself changes stays changed.
StudyCase CaseWith(const Ensemble& ensemble, const EnsembleSet& set, StudyCase one) {
  one.name = NameWith(set, one.name);
  std::vector<std::string> overrides = ensemble.Overrides(set, one.file);
  overrides.insert(overrides.end(), one.overrides.begin(), one.overrides.end());
  one.overrides = std::move(overrides);
  return one;
}

/// The claim with the names that its cases have with a set.
PlannedClaim ClaimWith(const EnsembleSet& set, PlannedClaim claim) {
  claim.cell.test_case = NameWith(set, claim.cell.test_case);
  if (claim.other) claim.other->test_case = NameWith(set, claim.other->test_case);
  return claim;
}

/// The design of a study that consists of one comparison, for a set.
StudyDesign DesignOf(const Ensemble& ensemble, std::string_view study, const EnsembleSet& set) {
  if (study == "policy") {
    const auto overrides = ensemble.Overrides(set, "paper.json");
    return PolicyDesign(ensemble.context.Load("paper.json", overrides));
  }
  if (study == "takeover") return TakeOverDesign();
  if (study == "transfer") return TransferDesign();
  if (study == "driver") return DriverDesign();
  if (study == "followers") return FollowersDesign();
  if (study == "vehicle") return VehicleDesign();
  throw std::out_of_range(fmt::format("study {} has no design", study));
}

const PlannedClaim* FindClaim(const StudyDesign& design, std::string_view says) {
  const auto found = std::ranges::find(design.claims, says, &PlannedClaim::says);
  return found == design.claims.end() ? nullptr : &*found;
}

template <class Named>
const Named& NamedIn(const std::vector<Named>& all, std::string_view name) {
  return *std::ranges::find(all, name, &Named::name);
}

/// Claims of one study that share cases and seeds, so that they share runs.
struct SharedRuns {
  std::string_view study;
  std::int64_t one_of = 1;
  std::vector<std::size_t> quoted;  // indices of the claims
  std::set<std::string> cases;
  std::set<std::string> variants;

  void Add(std::size_t index, const PlannedClaim& claim) {
    quoted.push_back(index);
    for (const CellName* cell : {&claim.cell, claim.other ? &*claim.other : &claim.cell}) {
      cases.insert(cell->test_case);
      variants.insert(cell->variant);
    }
  }
  bool Shares(const QuotedClaim& with, const PlannedClaim& claim) const {
    return study == with.study && one_of == with.one_of &&
           (cases.contains(claim.cell.test_case) ||
            (claim.other && cases.contains(claim.other->test_case)));
  }
};

/// The claim with its numbers. If runs end in collisions, a claim on safety becomes the claim that
/// there are fewer or more seeds with the less safe run on one side than on the other.
Claim SafetyWithCollisions(const Comparison& comparison, const PlannedClaim& planned) {
  Claim claim = ClaimOf(comparison, planned);
  if (claim.hindrance.empty() || planned.measure != kShortfall || planned.sign == Sign::kEqual) {
    return claim;
  }
  const Cell a = CellOf(comparison, planned.cell);
  const Cell b = CellOf(comparison, *planned.other);
  const std::vector<double> a_less_safe = comparison.LessSafe(a, b);
  const std::vector<double> b_less_safe = comparison.LessSafe(b, a);
  claim.difference = PairedDifference(a_less_safe, b_less_safe);
  claim.p = stats::McNemar(a_less_safe, b_less_safe);
  claim.compared += ", as the share of seeds in which it is less safe, collisions first";
  claim.hindrance.clear();
  return claim;
}

/// Runs the cells of all sets, and adds their claims to `result`.
void RunShared(const Ensemble& ensemble, const StudyContext& part, const SharedRuns& shared,
               EnsembleRuns& result) {
  std::vector<StudyDesign> designs;
  std::vector<StudyCase> cases;
  for (const EnsembleSet& set : ensemble.sets) {
    const StudyDesign& design = designs.emplace_back(DesignOf(ensemble, shared.study, set));
    for (const std::string& name : shared.cases) {
      cases.push_back(CaseWith(ensemble, set, NamedIn(design.cases, name)));
    }
  }
  std::vector<StudyVariant> variants;
  for (const std::string& name : shared.variants) {
    variants.push_back(NamedIn(designs.front().variants, name));
  }
  const Comparison comparison(part, std::move(cases), std::move(variants));
  result.runs += comparison.runs();
  for (std::size_t s = 0; s < designs.size(); ++s) {
    for (const std::size_t i : shared.quoted) {
      const PlannedClaim& planned = *FindClaim(designs[s], ensemble.quoted[i].says);
      result.claims[i].sets.push_back(
          SafetyWithCollisions(comparison, ClaimWith(ensemble.sets[s], planned)));
    }
  }
}

/// Runs the string of cars of a claim with all sets.
void RunStringOf(const Ensemble& ensemble, const StudyContext& part, std::size_t quoted,
                 EnsembleRuns& result) {
  const std::vector<StudyCase> kinds = StringKinds();
  const std::string_view says = ensemble.quoted[quoted].says;
  const auto kind = std::ranges::find_if(
      kinds, [&](const StudyCase& one) { return StringSays(one.name) == says; });
  std::vector<StudyCase> cases;
  for (const EnsembleSet& set : ensemble.sets) cases.push_back(CaseWith(ensemble, set, *kind));
  const std::vector<StringOutcome> strings = RunStrings(part, cases, HostVariants());
  result.claims[quoted].sets = ClaimsOnStrings(strings);
  result.runs += static_cast<std::int64_t>(strings.size()) * part.seeds.count();
}

/// Runs the mix of situations with a set, and adds the claim on a low threshold.
void RunMixOf(const Ensemble& ensemble, const StudyContext& part, const EnsembleSet& set,
              std::size_t quoted, EnsembleRuns& result) {
  constexpr std::array<std::string_view, 2> kRules{"fixed 0.3", "fixed 0.5"};
  const MixedRuns mixed = RunMix(part, RulesNamed(kRules), MixedHuman::kDrawn, MixedRadar::kDrawn,
                                 ensemble.Overrides(set, "paper.json"));
  Claim& claim = result.claims[quoted].sets.emplace_back(LowThresholdClaim(mixed));
  claim.compared = NameWith(set, claim.compared);
  result.runs += static_cast<std::int64_t>(kRules.size() + 1) * mixed.situations;
}

/// A part of the runs.
struct Job {
  std::int64_t one_of = 1;
  std::int64_t units = 0;  // of its progress, for each seed
  std::function<void(const StudyContext& part, EnsembleRuns& result)> run;

  /// The first of `one_of` equal parts of the seeds.
  sweep::SeedRange Seeds(sweep::SeedRange all) const {
    all.last = all.first + std::max<std::int64_t>(1, all.count() / one_of) - 1;
    return all;
  }
};

bool IsOnString(const QuotedClaim& quoted) {
  return std::ranges::any_of(StringKinds(), [&](const StudyCase& one) {
    return quoted.study == "followers" && StringSays(one.name) == quoted.says;
  });
}

std::vector<SharedRuns> PlanShared(const Ensemble& ensemble) {
  std::vector<SharedRuns> all;
  for (std::size_t i = 0; i < ensemble.quoted.size(); ++i) {
    const QuotedClaim& quoted = ensemble.quoted[i];
    if (quoted.study == "threshold" || IsOnString(quoted)) continue;
    const StudyDesign design = DesignOf(ensemble, quoted.study, ensemble.sets.front());
    const PlannedClaim* claim = FindClaim(design, quoted.says);
    if (claim == nullptr) {
      throw std::out_of_range(fmt::format("{} does not claim: {}", quoted.study, quoted.says));
    }
    const auto found = std::ranges::find_if(
        all, [&](const SharedRuns& one) { return one.Shares(quoted, *claim); });
    SharedRuns& shared =
        found != all.end()
            ? *found
            : all.emplace_back(SharedRuns{.study = quoted.study, .one_of = quoted.one_of});
    shared.Add(i, *claim);
  }
  return all;
}

std::vector<Job> JobsFor(const Ensemble& ensemble) {
  const auto sets = static_cast<std::int64_t>(ensemble.sets.size());
  std::vector<Job> jobs;
  for (SharedRuns& shared : PlanShared(ensemble)) {
    const auto cases = static_cast<std::int64_t>(shared.cases.size());
    jobs.push_back({.one_of = shared.one_of,
                    .units = cases * sets,
                    .run = [&ensemble, shared = std::move(shared)](const StudyContext& part,
                                                                   EnsembleRuns& result) {
                      RunShared(ensemble, part, shared, result);
                    }});
  }
  for (std::size_t i = 0; i < ensemble.quoted.size(); ++i) {
    const QuotedClaim& quoted = ensemble.quoted[i];
    if (IsOnString(quoted)) {
      jobs.push_back({.one_of = quoted.one_of,
                      .units = sets * static_cast<std::int64_t>(HostVariants().size()),
                      .run = [&ensemble, i](const StudyContext& part, EnsembleRuns& result) {
                        RunStringOf(ensemble, part, i, result);
                      }});
    }
    if (quoted.study != "threshold") continue;
    for (const EnsembleSet& set : ensemble.sets) {
      jobs.push_back({.one_of = quoted.one_of,
                      .units = 1,
                      .run = [&ensemble, &set, i](const StudyContext& part, EnsembleRuns& result) {
                        RunMixOf(ensemble, part, set, i, result);
                      }});
    }
  }
  return jobs;
}

}  // namespace

EnsembleRuns RunEnsemble(const StudyContext& context, std::span<const EnsembleSet> sets,
                         std::span<const QuotedClaim> quoted) {
  const Ensemble ensemble{context, sets, quoted};
  EnsembleRuns result;
  for (const QuotedClaim& one : quoted) result.claims.push_back({.quoted = one, .sets = {}});
  const std::vector<Job> jobs = JobsFor(ensemble);
  std::int64_t all = 0;
  for (const Job& job : jobs) all += job.units * job.Seeds(context.seeds).count();
  std::int64_t done = 0;
  for (const Job& job : jobs) {
    StudyContext part = context.Part(done, all);
    part.seeds = job.Seeds(context.seeds);
    job.run(part, result);
    done += job.units * part.seeds.count();
  }
  return result;
}

}  // namespace fogline::study
