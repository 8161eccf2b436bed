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
#include "tools/study/delays/delay_claims.h"
#include "tools/study/design.h"
#include "tools/study/detection/conflict_runs.h"
#include "tools/study/engagement/fog_modes.h"
#include "tools/study/followers/string_runs.h"
#include "tools/study/thresholds/both_humans.h"
#include "tools/study/thresholds/threshold_mix.h"

namespace fogline::study {
namespace {

/// The studies whose claims do not come from a Comparison.
constexpr std::string_view kThresholdStudy = "threshold";
constexpr std::string_view kConflictStudy = "conflict";

/// The input that all runs of this study share.
struct Ensemble {
  const StudyContext& context;
  std::span<const EnsembleSet> sets;
  std::span<const QuotedClaim> quoted;

  std::vector<std::string> Overrides(const EnsembleSet& set, std::string_view file) const {
    return OverridesOf(set, context.scenarios / file);
  }
};

/// The name of a case with a parameter set: "set 3: bias fog".
std::string NameWith(const EnsembleSet& set, std::string_view test_case) {
  return fmt::format("{}: {}", set.name, test_case);
}

/// The case with the parameters of a set. The overrides of the case come after the overrides of the
/// set, so the overrides of the case prevail.
StudyCase CaseWith(const Ensemble& ensemble, const EnsembleSet& set, StudyCase one) {
  one.name = NameWith(set, one.name);
  std::vector<std::string> overrides = ensemble.Overrides(set, one.file);
  overrides.insert(overrides.end(), one.overrides.begin(), one.overrides.end());
  one.overrides = std::move(overrides);
  return one;
}

/// The claim, with each of its cases renamed for a parameter set.
PlannedClaim ClaimWith(const EnsembleSet& set, PlannedClaim claim) {
  claim.cell.test_case = NameWith(set, claim.cell.test_case);
  if (claim.other) claim.other->test_case = NameWith(set, claim.other->test_case);
  return claim;
}

/// The design of a study for one parameter set. Only the studies whose claims come from a
/// Comparison have a design.
/// @throws std::out_of_range for other studies
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

/// Claims of one study that are decided by the same runs. The runs have all cases, variants and
/// seeds that these claims need.
struct SharedRuns {
  std::string_view study;
  std::int64_t one_of = 1;
  std::vector<std::size_t> quoted;  // indices of the claims in Ensemble::quoted
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

/// The claim with its numbers. If runs end early, a claim on the sign of a difference in safety
/// cannot hold. Then it becomes a claim on two numbers of seeds: the seeds in which the run of the
/// first cell is less safe, and the seeds in which the run of the second cell is less safe
/// (Comparison::LessSafe()).
Claim SafetyWithCollisions(const Comparison& comparison, const PlannedClaim& planned) {
  Claim claim = ClaimOf(comparison, planned);
  if (claim.hindrance.empty() || planned.measure != kShortfall || planned.sign == Sign::kEqual) {
    return claim;
  }
  const Cell a = CellOf(comparison, planned.cell);
  const Cell b = CellOf(comparison, *planned.other);
  const std::vector<double> a_less_safe = comparison.LessSafe(a, b);
  const std::vector<double> b_less_safe = comparison.LessSafe(b, a);
  claim.difference = PairedShareDifference(a_less_safe, b_less_safe);
  claim.p = stats::McNemar(a_less_safe, b_less_safe);
  claim.compared += ", as the share of seeds in which it is less safe, collisions first";
  claim.hindrance.clear();
  return claim;
}

/// Runs the cells of `shared` with all parameter sets, and adds the claims to `result`.
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

/// Runs the string of cars of a claim with all parameter sets.
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

/// Adds claims of study `study`, computed with one parameter set, to `result`. Each claim is added
/// to the quoted claim (QuotedClaim) of this study that has the same text.
void AddClaims(std::string_view study, const EnsembleSet& set, std::vector<Claim> claims,
               EnsembleRuns& result) {
  for (Claim& claim : claims) {
    claim.compared = NameWith(set, claim.compared);
    for (ClaimInSets& quoted : result.claims) {
      if (quoted.quoted.study == study && quoted.quoted.says == claim.says) {
        quoted.sets.push_back(claim);
      }
    }
  }
}

/// A mix of situations that is examined, and the name of the mix in its claims.
struct ExaminedMix {
  MixedHuman human;
  std::string_view name;
};
constexpr std::array<ExaminedMix, 2> kExaminedMixes{
    {{MixedHuman::kDrawn, ""}, {MixedHuman::kPerfect, kPerfectHuman}}};

/// Runs a mix of situations with one set of parameters, and adds the claims on fixed thresholds.
void RunMixOf(const Ensemble& ensemble, const StudyContext& part, const EnsembleSet& set,
              const ExaminedMix& mix, EnsembleRuns& result) {
  const MixedRuns mixed = RunMix(part, RulesNamed(kFixedRules), mix.human, MixedRadar::kDrawn,
                                 ensemble.Overrides(set, "paper.json"));
  AddClaims(kThresholdStudy, set, ClaimsOnFixed(mixed, mix.name), result);
  result.runs += static_cast<std::int64_t>(kFixedRules.size() + 1) * mixed.situations;
}

/// Runs the detectors with one set of parameters, and adds the claims on their delays.
void RunDelaysOf(const Ensemble& ensemble, const StudyContext& part, const EnsembleSet& set,
                 EnsembleRuns& result) {
  AddClaims(kConflictStudy, set, RunDelayClaims(part, ensemble.Overrides(set, "paper.json")),
            result);
  const std::int64_t of_seed = kDelayClearAir + static_cast<std::int64_t>(kVisibilities_m.size());
  result.runs += of_seed * part.seeds.count();
}

/// A part of the runs of study `ensemble`. Each part has its own number of seeds and its own
/// progress.
struct Job {
  std::int64_t one_of = 1;
  std::int64_t times = 1;
  std::int64_t units = 0;  // units of progress for each seed
  std::function<void(const StudyContext& part, EnsembleRuns& result)> run;

  /// The seeds of the job, from the first seed of `all` on. The number of seeds is all.count() *
  /// times / one_of, but at least 1.
  sweep::SeedRange Seeds(sweep::SeedRange all) const {
    all.last = all.first + std::max<std::int64_t>(1, all.count() * times / one_of) - 1;
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
    if (quoted.study == kThresholdStudy || quoted.study == kConflictStudy || IsOnString(quoted)) {
      continue;
    }
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

/// Adds a job for each parameter set, if Ensemble::quoted has a claim of the study `study`. All
/// quoted claims of this study share the runs of a job.
template <class Run>
void AddJobs(const Ensemble& ensemble, std::string_view study, std::int64_t units, Run run,
             std::vector<Job>& jobs) {
  const auto quoted = std::ranges::find(ensemble.quoted, study, &QuotedClaim::study);
  if (quoted == ensemble.quoted.end()) return;
  for (const EnsembleSet& set : ensemble.sets) {
    jobs.push_back({.one_of = quoted->one_of,
                    .times = quoted->times,
                    .units = units,
                    .run = [run, &set](const StudyContext& part, EnsembleRuns& result) {
                      run(part, set, result);
                    }});
  }
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
    if (!IsOnString(quoted)) continue;
    jobs.push_back({.one_of = quoted.one_of,
                    .units = sets * static_cast<std::int64_t>(HostVariants().size()),
                    .run = [&ensemble, i](const StudyContext& part, EnsembleRuns& result) {
                      RunStringOf(ensemble, part, i, result);
                    }});
  }
  for (const ExaminedMix& mix : kExaminedMixes) {
    AddJobs(
        ensemble, kThresholdStudy, 1,
        [&](const StudyContext& part, const EnsembleSet& set, EnsembleRuns& result) {
          RunMixOf(ensemble, part, set, mix, result);
        },
        jobs);
  }
  AddJobs(
      ensemble, kConflictStudy, kDelayUnits,
      [&](const StudyContext& part, const EnsembleSet& set, EnsembleRuns& result) {
        RunDelaysOf(ensemble, part, set, result);
      },
      jobs);
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
  for (const ClaimInSets& claim : result.claims) {
    if (claim.sets.size() == sets.size()) continue;
    throw std::out_of_range(
        fmt::format("{} does not claim: {}", claim.quoted.study, claim.quoted.says));
  }
  return result;
}

}  // namespace fogline::study
