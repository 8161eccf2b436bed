#include "tools/trials/results.h"

#include <utility>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/file.h"
#include "common/text.h"
#include "scenario/io/json.h"
#include "services/log/log_guard.h"

namespace fogline::trials {

namespace {

/// Whether a run has begun to write this log. A file that cannot be read also counts as begun,
/// because it may contain data.
bool HasBegun(const std::filesystem::path& log) {
  try {
    return log::HasSteps(log);
  } catch (const InputError&) {
    return true;
  }
}

/// Whether a folder has files. Temporary files do not count, because another session may be writing
/// them.
/// @throws InputError if the folder cannot be read
bool HasOtherFiles(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::directory_iterator entry(folder, failed);
  while (!failed && entry != std::filesystem::directory_iterator()) {
    if (!AtomicFile::IsTemporary(entry->path())) return true;
    entry.increment(failed);
  }
  if (!failed) return false;
  ThrowIfExhausted(failed.value(), PathText(folder));
  throw InputError(
      fmt::format("{}: error: --results: cannot read: {}", PathText(folder), failed.message()));
}

/// Whether a log without facts (TRIAL messages) can be a log of this trial: its run is in real
/// time, and its scenario is the scenario of the trial. A log has no facts if the network has lost
/// all facts of the run, and the session crashed after the run, before it added them to the log.
bool HasRunOf(const PlanFile& plan, const Trial& trial, const TrialStory& story) {
  if (!story.scenario || story.speed <= 0) return false;
  std::vector<std::string> seed;
  if (trial.seed >= 0) seed.push_back(fmt::format("/seed={}", trial.seed));
  try {
    Scenario expected = LoadCondition(plan, ConditionOf(plan.plan, trial), seed);
    if (story.scenario->person.drives) expected.person.drives = true;  // because --keys sets this
    expected.lead.sumo.version = story.scenario->lead.sumo.version;
    return PrintScenario(expected) == PrintScenario(*story.scenario);
  } catch (const InputError&) {
    return false;
  }
}

/// The reason why a log is not of this trial: its TRIAL messages (facts) name another trial or
/// another version of the experiment, or its run is not a run of this trial. "" if the log is of
/// this trial.
std::string WhyForeign(const PlanFile& plan, const Trial& trial, const TrialStory& story) {
  if (story.facts.empty()) {
    const bool may_be = story.state == TrialState::kBroken || HasRunOf(plan, trial, story);
    return may_be ? "" : "the log has no facts of a trial, and its run is not that of the trial";
  }
  for (const trial_t& fact : story.facts) {
    if (fact.participant != trial.participant || fact.trial != trial.number ||
        (fact.practice != 0) != trial.practice ||
        fact.condition != ConditionOf(plan.plan, trial).name) {
      return fmt::format("the log is of {} {} of participant {} in condition {}",
                         fact.practice != 0 ? "practice run" : "trial", fact.trial,
                         fact.participant, Quote(fact.condition));
    }
    if (fact.experiment_hash != plan.hash) return "the log is of another version of the experiment";
  }
  return "";
}

}  // namespace

Results::Results(const PlanFile& plan, std::filesystem::path folder)
    : plan_(plan), folder_(std::move(folder)) {
  std::error_code missing;
  if (!std::filesystem::exists(folder_, missing)) return;
  if (!std::filesystem::is_directory(folder_, missing)) {
    throw InputError(
        fmt::format("{}: error: --results: it is a file, not a folder", PathText(folder_)));
  }
  if (!HasOtherFiles(folder_)) return;
  // This check comes after HasOtherFiles(). Another session may create files at the same time, and
  // creates experiment.json first. So if HasOtherFiles() has seen files of that session, this check
  // finds experiment.json.
  if (!std::filesystem::exists(Kept(), missing)) {
    throw InputError(fmt::format("{}: error: --results: the folder has other files, and no {}",
                                 PathText(folder_), PathText(Kept().filename())));
  }
  CheckKept();
}

void Results::CheckKept() const {
  const FileText kept = ReadFile(Kept(), kMaxFileBytes);
  if (kept.error.empty() && kept.text == plan_.text) return;
  throw InputError(
      fmt::format("{}: error: --results: the experiment began with another version of {}, which is "
                  "{}; copy that file to {} to go on, or give another folder",
                  PathText(folder_), PathText(plan_.file), PathText(Kept()), PathText(plan_.file)));
}

void Results::Create() const {
  // "results/" is the folder "results".
  RequireFolderOf(folder_.has_filename() ? folder_ : folder_.parent_path(), "--results");
  std::error_code failed;
  std::filesystem::create_directory(folder_, failed);
  if (failed) {
    throw InputError(fmt::format("{}: error: --results: {}", PathText(folder_), failed.message()));
  }
  std::error_code missing;
  if (std::filesystem::exists(Kept(), missing)) return CheckKept();
  AtomicFile file(Kept());
  file.Write(plan_.text);
  if (!file.FinishNew()) CheckKept();  // another session was faster
}

std::unique_ptr<FileLock> Results::Begin(std::int64_t participant) const {
  Create();
  const std::filesystem::path folder = FolderOf(participant);
  std::error_code failed;
  std::filesystem::create_directory(folder, failed);
  if (failed) {
    throw InputError(fmt::format("{}: error: --results: {}", PathText(folder), failed.message()));
  }
  return std::make_unique<FileLock>(folder, FileLock::Kind::kOwn, "--participant", "session");
}

std::filesystem::path Results::FolderOf(std::int64_t participant) const {
  return folder_ / fmt::format("participant-{:02}", participant);
}

std::filesystem::path Results::LogOf(const Trial& trial, std::int64_t attempt) const {
  const std::string again = attempt > 1 ? fmt::format("-attempt-{}", attempt) : "";
  return FolderOf(trial.participant) /
         fmt::format("{}-{}-{}{}.lcm", trial.practice ? "practice" : "trial", trial.number,
                     ConditionOf(plan_.plan, trial).name, again);
}

TrialRecord Results::Read(const Trial& trial) const {
  TrialRecord record{.trial = trial, .attempts = 0, .log = "", .story = {}};
  record.story.state = TrialState::kOpen;
  std::error_code missing;
  while (std::filesystem::exists(LogOf(trial, record.attempts + 1), missing)) ++record.attempts;
  // A crash before the first step leaves a log without steps. Such an attempt does not count.
  while (record.attempts > 0 && !HasBegun(LogOf(trial, record.attempts))) --record.attempts;
  if (record.attempts == 0) return record;
  record.log = LogOf(trial, record.attempts);
  record.story = ReadStory(record.log);
  if (std::string why = WhyForeign(plan_, trial, record.story); !why.empty()) {
    record.story = {.state = TrialState::kBroken, .note = std::move(why)};
  }
  return record;
}

std::vector<TrialRecord> Results::ReadAll(std::int64_t participant) const {
  std::vector<TrialRecord> records;
  for (const Trial& trial : ScheduleOf(plan_.plan, participant)) records.push_back(Read(trial));
  return records;
}

}  // namespace fogline::trials
