// What a study is: a question, runs that answer it, and the answer in words, figures and files.
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

#include "scenario/scenario.h"
#include "tools/report/study_page.h"
#include "tools/sweep/plan.h"

namespace fogline {

/// Thrown out of a study that was told to stop.
class StudyStopped : public std::runtime_error {
 public:
  StudyStopped() : std::runtime_error("stopped") {}
};

/// What a study is given.
struct StudyContext {
  std::filesystem::path scenarios;  // folder with paper.json and dense_fog.json
  SeedRange seeds;
  int jobs = 1;
  /// Called again and again with what is done of how much; returns false to stop.
  std::function<bool(std::int64_t done, std::int64_t total)> progress;

  /// A scenario of the folder with overrides. @throws InputError
  Scenario Load(std::string_view file, const std::vector<std::string>& overrides = {}) const;
  /// @throws StudyStopped
  void Show(std::int64_t done, std::int64_t total) const;
};

struct StudyFile {
  std::string name;  // such as "policy.csv"
  std::string content;
};

/// What a study comes to. Nothing in it depends on the number of threads, the clock or the machine.
struct StudyResult {
  StudySection section;
  std::vector<StudyFile> files;
  std::int64_t runs = 0;
};

/// One study.
struct Study {
  std::string_view name;
  std::string_view title;
  std::string_view question;
  SeedRange seeds;  // unless --seeds says otherwise
  StudyResult (*run)(const StudyContext& context);
};

/// THE table of studies, in the order of `fogline study all`: the command line, its help and the
/// report come from it.
std::span<const Study> Studies();

/// The study of that name; nullptr if there is none.
const Study* FindStudy(std::string_view name);

// One file each.
StudyResult RunConflictStudy(const StudyContext& context);
StudyResult RunPolicyStudy(const StudyContext& context);
StudyResult RunTransferStudy(const StudyContext& context);
StudyResult RunThresholdStudy(const StudyContext& context);
StudyResult RunDriverStudy(const StudyContext& context);
StudyResult RunFollowersStudy(const StudyContext& context);
StudyResult RunVehicleStudy(const StudyContext& context);

}  // namespace fogline
