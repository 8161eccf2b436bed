#include <algorithm>

#include "scenario/io/loader.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

// The table of Studies().
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
     {1, 500},
     RunPolicyStudy},
    {"takeover",
     "A driver who needs time",
     "What does traded control gain if the driver must be asked, and needs time?",
     {1, 300},
     RunTakeOverStudy},
    {"transfer",
     "How to hand over",
     "Is a smooth transfer worth its cost in safety?",
     {1, 1000},
     RunTransferStudy},
    {"threshold",
     "Fixed and adaptive thresholds",
     "Does a threshold that moves with the situation give more safety at equal redundant "
     "engagement?",
     {1, 1000},
     RunThresholdStudy},
    {"driver",
     "Imperfect human drivers",
     "How much does traded control still help if the human who takes over is imperfect?",
     {1, 300},
     RunDriverStudy},
    {"followers",
     "Drivers behind the host",
     "Does traded control help every kind of follower?",
     {1, 300},
     RunFollowersStudy},
    {"vehicle",
     "Cars with engines, brakes and tyres",
     "Does traded control still help in a car that does not follow its commands exactly?",
     {1, 300},
     RunVehicleStudy},
    {"ensemble",
     "Other parameters that meet the table",
     "Which findings hold for every parameter set that meets the published table?",
     {1, 136},
     RunEnsembleStudy,
     true},
};

}  // namespace

std::span<const Study> Studies() { return kStudies; }

const Study* FindStudy(std::string_view name) {
  const auto found = std::ranges::find(kStudies, name, &Study::name);
  return found == std::end(kStudies) ? nullptr : &*found;
}

Scenario StudyContext::Load(std::string_view file, std::vector<std::string> overrides,
                            const std::vector<std::string>& more) const {
  overrides.insert(overrides.end(), more.begin(), more.end());
  return LoadScenario(scenarios / file, overrides);
}

StudyContext StudyContext::Part(std::int64_t before, std::int64_t all) const {
  StudyContext part = *this;
  part.progress = [show = progress, before, all](std::int64_t done, std::int64_t) {
    return !show || show(before + done, all);
  };
  return part;
}

void StudyContext::Show(std::int64_t done, std::int64_t total) const {
  if (progress && !progress(done, total)) throw StudyStopped();
}

}  // namespace fogline::study
