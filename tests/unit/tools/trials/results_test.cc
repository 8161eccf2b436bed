#include "tools/trials/results.h"

#include <sys/resource.h>

#include <array>
#include <barrier>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "tests/support/command.h"
#include "tests/support/input_errors.h"

namespace fogline::trials {
namespace {

using ::testing::HasSubstr;

PlanFile Plan() {
  PlanFile file{.file = "e.json", .text = "{}\n", .hash = "", .plan = {}};
  file.plan.conditions.resize(1);
  file.plan.conditions[0].name = "fog";
  return file;
}

TEST(ResultsTest, EachAttemptHasALogOfItsOwn) {
  const test::ScratchFolder folder;
  const PlanFile plan = Plan();
  const Results results(plan, folder.path() / "r");
  const Trial trial{.participant = 3, .practice = false, .number = 2, .index = 0};
  EXPECT_EQ(results.LogOf(trial, 1), folder.path() / "r/participant-03/trial-2-fog.lcm");
  EXPECT_EQ(results.LogOf(trial, 2), folder.path() / "r/participant-03/trial-2-fog-attempt-2.lcm");
}

TEST(ResultsTest, TheNewestAttemptCounts) {
  const test::ScratchFolder folder;
  const PlanFile plan = Plan();
  const Results results(plan, folder.path() / "r");
  const Trial trial{.participant = 1, .practice = false, .number = 1, .index = 0};
  EXPECT_EQ(results.Read(trial).story.state, TrialState::kOpen);
  std::filesystem::create_directories(results.FolderOf(1));
  std::ofstream(results.LogOf(trial, 1)) << "no log";
  std::ofstream(results.LogOf(trial, 2)) << "no log";
  const TrialRecord record = results.Read(trial);
  EXPECT_EQ(record.attempts, 2);
  EXPECT_EQ(record.log, results.LogOf(trial, 2));
  EXPECT_EQ(record.story.state, TrialState::kBroken);
}

TEST(ResultsTest, ALogWithoutAStepIsNoAttempt) {
  const test::ScratchFolder folder;
  const PlanFile plan = Plan();
  const Results results(plan, folder.path() / "r");
  const Trial trial{.participant = 1, .practice = false, .number = 1, .index = 0};
  std::filesystem::create_directories(results.FolderOf(1));
  std::ofstream(results.LogOf(trial, 1)) << "";
  EXPECT_EQ(results.Read(trial).attempts, 0);
  EXPECT_EQ(results.Read(trial).story.state, TrialState::kOpen);
  std::ofstream(results.LogOf(trial, 1)) << "no log";
  std::ofstream(results.LogOf(trial, 2)) << "";
  const TrialRecord record = results.Read(trial);
  EXPECT_EQ(record.attempts, 1);
  EXPECT_EQ(record.log, results.LogOf(trial, 1));
}

TEST(ResultsTest, AFolderBelongsToOneVersionOfAnExperiment) {
  const test::ScratchFolder folder;
  PlanFile plan = Plan();
  const Results results(plan, folder.path() / "r");
  results.Create();
  EXPECT_NO_THROW(Results(plan, folder.path() / "r"));
  PlanFile other = Plan();
  other.text = "{ }\n";
  EXPECT_EQ(test::Content(folder.File("r/experiment.json")), plan.text);
  std::filesystem::create_directories(results.FolderOf(1));
  std::ofstream(results.FolderOf(1) / "trial-1-fog.lcm") << "no log";
  try {
    Results(other, folder.path() / "r");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("another version of e.json"));
  }
}

TEST(ResultsTest, TheFileOfTheFirstOfTwoSessionsIsKept) {
  const test::ScratchFolder folder;
  const PlanFile plan = Plan();
  PlanFile other = Plan();
  other.text = "{ }\n";
  const Results first(plan, folder.path() / "r");
  const Results second(other, folder.path() / "r");
  first.Create();
  EXPECT_THAT(test::ErrorOf([&second] { second.Create(); }),
              HasSubstr("another version of e.json"));
  EXPECT_EQ(test::Content(folder.File("r/experiment.json")), plan.text);
}

TEST(ResultsTest, TwoFirstSessionsAtTheSameTimeKeepOneFileOfTheExperiment) {
  constexpr int kRounds = 50;
  const test::ScratchFolder folder;
  const PlanFile plan = Plan();
  PlanFile other = Plan();
  other.text = "{ }\n";
  for (int round = 0; round < kRounds; ++round) {
    const std::filesystem::path results = folder.path() / std::to_string(round);
    std::array<std::string, 2> errors;
    {
      std::barrier start(2);
      const auto session = [&](const PlanFile& own, std::string& error) {
        start.arrive_and_wait();
        error = test::ErrorOf<std::exception>([&] { Results(own, results).Create(); });
      };
      const std::jthread first([&] { session(plan, errors[0]); });
      const std::jthread second([&] { session(other, errors[1]); });
    }
    const bool first_made_it = errors[0].empty();
    EXPECT_THAT(errors[first_made_it ? 1 : 0], HasSubstr("another version of e.json"));
    EXPECT_EQ(errors[first_made_it ? 0 : 1], "");
    EXPECT_EQ(test::Content((results / "experiment.json").string()),
              first_made_it ? plan.text : other.text);
  }
}

TEST(ResultsTest, AFolderInWhichASessionBeginsIsAccepted) {
  const test::ScratchFolder folder;
  const PlanFile plan = Plan();
  AtomicFile file(folder.path() / "experiment.json");
  file.Write(plan.text);
  EXPECT_NO_THROW(Results(plan, folder.path()));
  file.Finish();
  EXPECT_NO_THROW(Results(plan, folder.path()).Create());
}

TEST(ResultsTest, AFolderWithOtherFilesIsRefused) {
  const test::ScratchFolder folder;
  std::ofstream(folder.File("thesis.txt")) << "text";
  const PlanFile plan = Plan();
  const AtomicFile temporary(folder.path() / "experiment.json");
  EXPECT_EQ(test::ErrorOf([&] { Results(plan, folder.path()); }),
            folder.path().string() +
                ": error: --results: the folder has other files, and no experiment.json");
  EXPECT_EQ(test::ErrorOf([&] { Results(plan, folder.File("thesis.txt")); }),
            folder.File("thesis.txt") + ": error: --results: it is a file, not a folder");
}

TEST(ResultsTest, AFolderThatCannotBeReadIsRefused) {
  const test::ScratchFolder folder;
  const PlanFile plan = Plan();
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  const rlimit none{.rlim_cur = 0, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
  const std::string error =
      test::ErrorOf<std::runtime_error>([&] { Results(plan, folder.path()); });
  setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_THAT(error, HasSubstr("Too many open files"));
}

}  // namespace
}  // namespace fogline::trials
