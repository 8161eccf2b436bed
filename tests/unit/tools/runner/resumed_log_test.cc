#include "tools/runner/resumed_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "services/runtime/wire/wire.h"
#include "tests/support/copied_log.h"
#include "tests/support/input_errors.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::test {
namespace {

using runner::ResumedLog;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::int64_t kResumedSteps = 20;
constexpr std::int64_t kResumedCut = 12;

class ResumedLogTest : public testing::Test {
 protected:
  ResumedLogTest() { runner::RunScenario(Paper(kResumedSteps), Direct(log_)); }

  /// A copy of the log that ends after step kResumedCut - 1, like the log of a killed recorder.
  std::string CutOff() const {
    std::string part = folder_.File("part.lcm");
    Copy(log_, part,
         [](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>& data) {
           return event.channel == "RUN" ||
                  runtime::ReadInt64(data, runtime::kStepOffset) < kResumedCut;
         });
    return part;
  }
  /// The reason why a log cannot be resumed; "" if the log can be resumed.
  static std::string Refusal(const std::string& log, const runtime::SigningKey* key = nullptr) {
    return ErrorOf([&] { const ResumedLog resumed(log, key); });
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
};

TEST_F(ResumedLogTest, HasAllStepsOfACompleteRun) {
  const ResumedLog log(log_, nullptr);
  EXPECT_TRUE(log.complete());
  EXPECT_EQ(log.resumption().remains.steps, kResumedSteps);
  EXPECT_EQ(PrintScenario(log.scenario()), PrintScenario(Paper(kResumedSteps)));
}

TEST_F(ResumedLogTest, HasTheStepsOfARunThatEndedEarly) {
  const ResumedLog log(CutOff(), nullptr);
  EXPECT_FALSE(log.complete());
  EXPECT_EQ(log.resumption().remains.steps, kResumedCut);
  EXPECT_EQ(log.resumption().front.run_id, ReadToTheEnd(log_).run_id);
  EXPECT_EQ(PrintScenario(log.scenario()), PrintScenario(Paper(kResumedSteps)));
}

TEST_F(ResumedLogTest, IsLockedAgainstOtherRunsUntilItEnds) {
  {
    const ResumedLog log(log_, nullptr);
    EXPECT_THAT(Refusal(log_), HasSubstr(": error: --resume: is being written by another run"));
  }
  EXPECT_EQ(Refusal(log_), "");
}

TEST_F(ResumedLogTest, IsLeftAsItIsIfItIsRefused) {
  const std::string text = folder_.File("text");
  std::ofstream(text) << "no log";
  EXPECT_EQ(Refusal(text), text + ": error: not an LCM event log");
  EXPECT_EQ(Content(text), "no log");
  const std::string missing = folder_.File("missing.lcm");
  EXPECT_THAT(Refusal(missing), HasSubstr("No such file or directory"));
  EXPECT_FALSE(std::filesystem::exists(missing));
}

TEST_F(ResumedLogTest, IsNoLogWithoutAScenario) {
  const std::string empty = folder_.File("empty.lcm");
  std::ofstream(empty).flush();
  EXPECT_EQ(Refusal(empty),
            empty +
                ": error: --resume: the log does not begin with the scenario of a run: start a "
                "new run");
}

TEST_F(ResumedLogTest, IsNotOneThatWasChangedSinceItWasSealed) {
  const std::string altered = folder_.File("altered.lcm");
  Copy(log_, altered,
       [](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>& data) {
         if (event.channel == "DRIVER_COMMAND") data[runtime::kHeaderEnd + 7] ^= 1;
         return true;
       });
  EXPECT_THAT(Refusal(altered),
              StartsWith(altered + ": error: --resume: the log is not the one that was sealed: "));
}

TEST_F(ResumedLogTest, IsSealedWithTheSameKey) {
  const runtime::SigningKey key({1, 2, 3});
  EXPECT_EQ(Refusal(log_, &key),
            log_ + ": error: --resume: the seal of the log is not signed with this key");
  EXPECT_EQ(Refusal(CutOff(), &key), "") << "it has no seal";
}

TEST_F(ResumedLogTest, IsNotResumedWithoutTheKeyThatSignedItsSeal) {
  const std::string key_file = folder_.File("key");
  runtime::SigningKey::Create(key_file);
  runner::RunOptions options = Direct(folder_.File("signed.lcm"));
  options.traffic.key_file = key_file;
  runner::RunScenario(Paper(kResumedSteps), options);
  const std::string log = options.log.string();
  EXPECT_EQ(
      Refusal(log),
      log + ": error: --resume: the seal of the log is signed, and --key does not name its key");
  const runtime::SigningKey other({1, 2, 3});
  EXPECT_EQ(Refusal(log, &other),
            log + ": error: --resume: the seal of the log is not signed with this key");
  const runtime::SigningKey own = runtime::SigningKey::Load(key_file);
  EXPECT_EQ(Refusal(log, &own), "");
}

TEST_F(ResumedLogTest, HasNothingBehindItsStepsThatNoRunLeaves) {
  const std::string odd = folder_.File("odd.lcm");
  Copy(log_, odd,
       [](log::EventLogWriter& log, const log::Event& event, std::vector<std::uint8_t>& data) {
         if (event.channel == "RUN") return true;
         if (runtime::ReadInt64(data, runtime::kStepOffset) < kResumedCut) return true;
         log.Write("OTHER", 0, data);
         return false;
       });
  EXPECT_THAT(Refusal(odd), HasSubstr(": fogline run does not leave a log like this"));
}

}  // namespace
}  // namespace fogline::test
