// A study: a question, runs that answer the question, and the answer in words, claims, figures and
// files. A person writes the answer, without numbers. The claims check the answer against the
// numbers (claims.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sections/scenario.h"
#include "tools/report/study_page.h"
#include "tools/study/claim.h"
#include "tools/sweep/plan.h"

namespace fogline::study {

/// Thrown by a study whose progress callback returned false.
class StudyStopped : public std::runtime_error {
 public:
  StudyStopped() : std::runtime_error("stopped") {}
};

/// Input of a study.
struct StudyContext {
  std::filesystem::path scenarios;  // folder with paper.json, dense_fog.json and ensemble/
  sweep::SeedRange seeds;
  int jobs = 1;
  /// Called repeatedly with the finished and the total number of units; returns false to stop.
  std::function<bool(std::int64_t done, std::int64_t total)> progress;

  /// Loads a scenario of the folder. `overrides` are applied first, and then `more`.
  /// @throws InputError
  Scenario Load(std::string_view file, std::vector<std::string> overrides,
                const std::vector<std::string>& more = {}) const;
  /// The context for one part of a study. The study has `all` units, and `before` of them are done
  /// when the part begins.
  StudyContext Part(std::int64_t before, std::int64_t all) const;
  /// Calls `progress`. @throws StudyStopped if it returns false
  void Show(std::int64_t done, std::int64_t total) const;
};

struct StudyFile {
  std::string name;  // such as "policy.csv"
  std::string content;
};

/// Result of a study. It does not depend on the number of threads or the clock. On another machine
/// the result is the same if the mathematical functions of the machine's C library compute the same
/// last bits.
struct StudyResult {
  report::StudySection section;  // the section's claims are empty until they are checked
  std::vector<Claim> claims;
  std::vector<StudyFile> files;
  std::int64_t runs = 0;
};

/// A row of the table Studies().
struct Study {
  std::string_view name;
  std::string_view title;
  std::string_view question;
  sweep::SeedRange seeds;  // default of --seeds
  StudyResult (*run)(const StudyContext& context);
  bool needs_sets = false;  // whether the study reads the parameter sets of scenario/ensemble
};

/// The table of all studies, in the order of `fogline study all`. The command line, its help and
/// the report use it.
std::span<const Study> Studies();

/// The study with this name; nullptr if there is none.
const Study* FindStudy(std::string_view name);

// Each of these functions has a file of its own.
StudyResult RunConflictStudy(const StudyContext& context);
StudyResult RunPolicyStudy(const StudyContext& context);
StudyResult RunTakeOverStudy(const StudyContext& context);
StudyResult RunTransferStudy(const StudyContext& context);
StudyResult RunThresholdStudy(const StudyContext& context);
StudyResult RunDriverStudy(const StudyContext& context);
StudyResult RunFollowersStudy(const StudyContext& context);
StudyResult RunVehicleStudy(const StudyContext& context);
StudyResult RunEnsembleStudy(const StudyContext& context);

}  // namespace fogline::study
