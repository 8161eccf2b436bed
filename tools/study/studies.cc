#include <algorithm>

#include "scenario/io/loader.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

// One row for each study.
constexpr Study kStudies[] = {
    {"conflict",
     "Conflict measures at equal false-alarm rate",
     "Which measure of conflict between radar and LiDAR notices fog first, if all of them raise "
     "equally many false alarms?",
     {1, 200},
     RunConflictStudy},
    {"policy",
     "Who should drive in fog",
     "What do hand-over, isolation of the deceived sensor and shared control do to safety and "
     "comfort?",
     {1, 1000},
     RunPolicyStudy},
    {"transfer",
     "How to hand over",
     "What does a smooth transfer cost in safety, and what does it spare in jerk?",
     {1, 1000},
     RunTransferStudy},
    {"threshold",
     "Fixed and adaptive thresholds",
     "Does a threshold that moves with the situation give more safety at equal redundant "
     "engagement?",
     {1, 1000},
     RunThresholdStudy},
    {"driver",
     "Human drivers who see and judge less than the truth",
     "What is left of traded control if the human who takes over is one?",
     {1, 300},
     RunDriverStudy},
    {"followers",
     "Who drives behind",
     "Does traded control help every kind of follower?",
     {1, 300},
     RunFollowersStudy},
    {"vehicle",
     "Cars with engines, brakes and tyres",
     "Does traded control survive a car that does not do what it is told?",
     {1, 300},
     RunVehicleStudy},
};

}  // namespace

std::span<const Study> Studies() { return kStudies; }

const Study* FindStudy(std::string_view name) {
  const auto found = std::ranges::find(kStudies, name, &Study::name);
  return found == std::end(kStudies) ? nullptr : &*found;
}

Scenario StudyContext::Load(std::string_view file,
                            const std::vector<std::string>& overrides) const {
  return LoadScenario(scenarios / file, overrides);
}

void StudyContext::Show(std::int64_t done, std::int64_t total) const {
  if (progress && !progress(done, total)) throw StudyStopped();
}

}  // namespace fogline::study
