// The folder with the logs of an experiment. Each trial has a log of its own, which is never
// overwritten:
//
//   experiment.json                              the experiment's file, as it was at the beginning
//   participant-03/practice-1-clear.lcm
//   participant-03/trial-2-fog.lcm
//   participant-03/trial-2-fog-attempt-2.lcm     the first run of this trial broke off
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/file_lock.h"
#include "tools/trials/plan_file.h"
#include "tools/trials/schedule.h"
#include "tools/trials/trial_log.h"

namespace fogline::trials {

/// The newest run of a trial.
struct TrialRecord {
  Trial trial;
  std::int64_t attempts = 0;  // number of runs
  std::filesystem::path log;  // of the newest run; "" without a run
  TrialStory story;           // of the newest run; kOpen without a run

  /// Whether the trial has no complete run.
  bool NeedsRun() const {
    return story.state == TrialState::kOpen || story.state == TrialState::kBroken;
  }
};

class Results {
 public:
  /// @throws InputError if the folder has the results of another experiment, or of another version
  ///     of this one
  Results(const PlanFile& plan, std::filesystem::path folder);

  /// Creates the folder, and copies the experiment's file into it. @throws InputError
  void Create() const;
  /// Calls Create(). Then creates the folder of a participant, and locks it for a session.
  /// @throws InputError
  std::unique_ptr<FileLock> Begin(std::int64_t participant) const;

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path FolderOf(std::int64_t participant) const;
  /// The log of a run of a trial. @param attempt from 1 on
  std::filesystem::path LogOf(const Trial& trial, std::int64_t attempt) const;

  /// The newest run of a trial. If the newest log has no step, its run never began. Then this log
  /// does not count, and the log of the next run gets the same name. A log of another trial, or of
  /// another version of the experiment, counts as the log of a broken run.
  TrialRecord Read(const Trial& trial) const;
  /// All practice runs and trials of a participant, in their order.
  std::vector<TrialRecord> ReadAll(std::int64_t participant) const;

 private:
  /// @throws InputError if the kept file is that of another version of the experiment
  void CheckKept() const;
  std::filesystem::path Kept() const { return folder_ / "experiment.json"; }

  const PlanFile& plan_;
  std::filesystem::path folder_;
};

}  // namespace fogline::trials
