// `fogline run --resume` verifies and seals a log that has the whole run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "services/graph.h"
#include "services/log/event_log.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/wire.h"
#include "tests/integration/faults/resume_fixture.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

class ResumeOfCompleteLogTest : public ResumeTest {
 protected:
  /// Copies whole.lcm without its seal. A runner that is killed after the last step leaves such a
  /// log.
  void LeaveUnsealed() const {
    Copy(File("whole.lcm"), log_,
         [](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>&) {
           return event.channel != "FOGLINE_SEAL";
         });
  }
  /// Does the same as LeaveUnsealed(), but the RADAR of step 100 differs from what the radar
  /// computed.
  void LeaveForgedAndUnsealed() const {
    Copy(File("whole.lcm"), log_,
         [](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>& data) {
           const std::int64_t step = runtime::ReadInt64(data, runtime::kStepOffset);
           if (step == 100 && event.channel == "RADAR") data[runtime::kHeaderEnd + 7] ^= 1;
           return event.channel != "FOGLINE_SEAL";
         });
  }
  /// The JSON result of `fogline digest` for the log.
  nlohmann::json Digest(const Words& more = {}) const {
    const Outcome outcome = RunCommand(Words{Program("fogline"), "digest", "--json", log_} + more);
    const auto json = nlohmann::json::parse(outcome.out, nullptr, false);
    EXPECT_TRUE(json.is_array() && json.size() == 1) << outcome.out << outcome.err;
    return json.is_array() && !json.empty() ? json[0] : nlohmann::json::object();
  }
};

TEST_F(ResumeOfCompleteLogTest, SaysTheResultAgainAndComputesNothing) {
  Undisturbed();
  std::filesystem::copy(File("whole.lcm"), log_);
  const auto whole = Undisturbed();
  const Outcome outcome = Resume();
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, log_ + ": the run is complete\n");
  const auto result = ExpectSameEnd(whole);
  EXPECT_EQ(result["resumed_steps"], kResumeSteps);
  EXPECT_EQ(result["transport"], nullptr);
  EXPECT_EQ(result["log"], log_);
  EXPECT_EQ(ExpectSameEnd(whole, {"--verify"})["verified"]["roles"].size(), kRoles.size() - 1);
}

TEST_F(ResumeOfCompleteLogTest, RefusesAWallClockBecauseTheLogDecides) {
  Undisturbed();
  std::filesystem::copy(File("whole.lcm"), log_);
  const Outcome outcome = Resume({"--wall-clock"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--wall-clock: --resume goes on as the log began"));
}

TEST_F(ResumeOfCompleteLogTest, SaysThatViewHasNothingToShow) {
  Undisturbed();
  std::filesystem::copy(File("whole.lcm"), log_);
  const Outcome outcome = Resume({"--view"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err,
              HasSubstr("--view: no page was opened; fogline view " + log_ + " shows the log"));
}

TEST_F(ResumeOfCompleteLogTest, ComputesAgainWhatItGoesOnFrom) {
  Undisturbed();
  // GIVEN a log that was changed at step 100. When a run continues, all roles publish the last
  // steps of its log again. Step 100 is before these last steps, so only the verification of the
  // whole log finds the change
  const auto resume = [&](std::int64_t steps, const Words& more) {
    Copy(File("whole.lcm"), log_,
         [&](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>& data) {
           const std::int64_t step = runtime::ReadInt64(data, runtime::kStepOffset);
           if (step == 100 && event.channel == "DRIVER_COMMAND") data[runtime::kHeaderEnd + 7] ^= 1;
           return step < steps && event.channel != "FOGLINE_SEAL";
         });
    return Resume(more);
  };
  const auto expect_found = [](const Outcome& outcome) {
    EXPECT_THAT(outcome.err, HasSubstr("error: step 100: DRIVER_COMMAND of driver: "));
    EXPECT_EQ(outcome.code, 1);
  };
  expect_found(resume(250, {"--transport", "memq"}));
  EXPECT_EQ(resume(250, {"--transport", "memq", "--no-verify"}).code, 0);
  expect_found(resume(kResumeSteps, {}));
  EXPECT_EQ(resume(kResumeSteps, {"--no-verify"}).code, 0);
}

TEST_F(ResumeOfCompleteLogTest, VerifiesAndSealsTheLogOfARunnerThatDiedBeforeItSealed) {
  const auto whole = Undisturbed();
  LeaveUnsealed();
  EXPECT_EQ(ExpectSameEnd(whole)["verified"]["roles"].size(), kRoles.size() - 1);
  EXPECT_EQ(Digest()["seal"], "holds");
  // AND the seal names the builds of the roles, so that the roles can be verified again
  const auto again = ExpectSameEnd(whole, {"--verify"})["verified"];
  EXPECT_EQ(again["roles"].size(), kRoles.size() - 1) << again;
  EXPECT_TRUE(again["left_out"].empty()) << again;
}

TEST_F(ResumeOfCompleteLogTest, SealsALogWhoseSealIsTorn) {
  const auto whole = Undisturbed();
  // A computer that crashes may leave a part of the seal. The shortest part is one byte.
  LeaveUnsealed();
  const auto steps = std::filesystem::file_size(log_);
  const auto sealed = std::filesystem::file_size(File("whole.lcm"));
  for (const auto bytes : {steps + 1, (steps + sealed) / 2, sealed - 1}) {
    SCOPED_TRACE(bytes);
    std::filesystem::copy(File("whole.lcm"), log_,
                          std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(log_, bytes);
    EXPECT_EQ(ExpectSameEnd(whole)["verified"]["roles"].size(), kRoles.size() - 1);
    EXPECT_EQ(Digest()["seal"], "holds");
    log::RunLogReader reader(log_);
    while (reader.Next() != nullptr) {
    }
    EXPECT_TRUE(reader.run().complete);
    EXPECT_EQ(reader.run().seal.value().says.complete, 1);
  }
}

TEST_F(ResumeOfCompleteLogTest, LeavesALogWithATornSealAsItIsUnlessItSealsIt) {
  Undisturbed();
  const auto tear = [this] {
    std::ofstream(log_, std::ios::app | std::ios::binary) << "a part of a seal";
    return Content(log_);
  };
  LeaveForgedAndUnsealed();
  const std::string forged = tear();
  EXPECT_EQ(Resume().code, 1);
  EXPECT_TRUE(Content(log_) == forged);
  LeaveUnsealed();
  const std::string torn = tear();
  EXPECT_EQ(Resume({"--no-verify"}).code, 0);
  EXPECT_TRUE(Content(log_) == torn);
}

TEST_F(ResumeOfCompleteLogTest, DoesNotComputeAgainWhatAnExternalRoleHasComputed) {
  Undisturbed();
  // GIVEN the log of a run with another driver, whose runner was killed before it sealed the log
  const auto leave = [this] {
    Copy(File("whole.lcm"), log_,
         [](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>& data) {
           const std::int64_t step = runtime::ReadInt64(data, runtime::kStepOffset);
           if (step == 100 && event.channel == "DRIVER_COMMAND") data[runtime::kHeaderEnd + 7] ^= 1;
           return event.channel != "FOGLINE_SEAL";
         });
  };
  const Words external{"--external", "driver", "--lcm-url", runtime::FreshMulticastUrl()};
  leave();
  EXPECT_EQ(Resume().code, 1) << "without --external, the driver counts as Fogline's";
  leave();
  const Outcome outcome = Resume(external);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto verified = nlohmann::json::parse(outcome.out, nullptr, false)["verified"];
  EXPECT_EQ(verified["roles"].size(), kRoles.size() - 2) << verified;
  EXPECT_EQ(verified["left_out"].size(), 1U) << verified;
  EXPECT_EQ(Digest()["seal"], "holds");
}

TEST_F(ResumeOfCompleteLogTest, SealsNothingThatItHasNotVerified) {
  Undisturbed();
  const std::string key = File("key");
  ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
  for (const Words& more : {Words{}, Words{"--key", key}}) {
    for (const bool forged : {false, true}) {
      SCOPED_TRACE(testing::Message() << "key: " << !more.empty() << ", forged: " << forged);
      forged ? LeaveForgedAndUnsealed() : LeaveUnsealed();
      const std::string before = Content(log_);
      const Outcome outcome = Resume(Words{"--no-verify"} + more);
      EXPECT_EQ(outcome.code, 0) << outcome.err;
      EXPECT_TRUE(Content(log_) == before) << "the file is left as it is";
      EXPECT_NE(Digest()["seal"], "holds");
    }
  }
}

TEST_F(ResumeOfCompleteLogTest, SealsNoLogThatDiffersFromWhatTheRolesCompute) {
  Undisturbed();
  LeaveForgedAndUnsealed();
  const std::string before = Content(log_);
  const Outcome outcome = Resume();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("error: step 100: RADAR of radar: "));
  EXPECT_TRUE(Content(log_) == before) << "the file is left as it is";
}

}  // namespace
}  // namespace fogline::test
