#include "services/runtime/realtime/fallback_log.h"

#include <gtest/gtest.h>

#include <utility>

namespace fogline {
namespace {

constexpr std::int64_t kStep_us = 100'000;
using Inputs = std::vector<std::pair<std::string, std::int8_t>>;
constexpr std::int8_t kOk = status_t::INPUT_OK;
constexpr std::int8_t kStale = status_t::INPUT_STALE;
constexpr std::int8_t kLost = status_t::INPUT_LOST;

class FallbackLogTest : public testing::Test {
 protected:
  /// The STATUS of a role at a step. The role waits for the first input that is not OK.
  status_t Said(const std::string& role, std::int64_t step, const Inputs& inputs,
                const std::string& fallback = "") {
    status_t status{};
    status.header = {.run_id = 1, .step = step, .utime = step * kStep_us};
    status.role = role;
    status.instance = 1;
    status.state = status_t::RUNNING;
    status.fallback = fallback;
    status.num_inputs = static_cast<std::int32_t>(inputs.size());
    for (const auto& [channel, state] : inputs) {
      status.input.push_back(channel);
      status.input_state.push_back(state);
      if (state != kOk && status.waiting_for.empty()) {
        status.waiting_for = channel;
        status.last_heard_ms = 250;
      }
    }
    return status;
  }
  /// The text of the change that this STATUS causes, "" if it causes no change.
  std::string Add(const status_t& status) {
    const runtime::Fallback* change = log_.Add(status);
    return change != nullptr ? change->Text() : "";
  }

  static constexpr std::int64_t kSteps = 100'000;
  runtime::FallbackLog log_{kStep_us, 1, kSteps};
};

TEST_F(FallbackLogTest, NamesTheLostInputsTheCulpritAndTheFallback) {
  EXPECT_EQ(Add(Said("arbitrator", 10, {{"TRACK", kOk}})), "");
  EXPECT_EQ(Add(Said("arbitrator", 13, {{"TRACK", kLost}}, "the human drives")),
            "step 13: arbitrator: TRACK lost (culprit: fusion, last heard 0.25 s ago): "
            "the human drives");
  EXPECT_EQ(Add(Said("arbitrator", 14, {{"TRACK", kLost}}, "the human drives")), "");
  EXPECT_EQ(Add(Said("arbitrator", 30, {{"TRACK", kOk}})),
            "step 30: arbitrator: TRACK ok again: as usual again");
  EXPECT_EQ(log_.all().size(), 2U);
}

TEST_F(FallbackLogTest, TakesAStaleInputForNewsOnlyIfSomethingIsDoneAboutIt) {
  EXPECT_EQ(Add(Said("world", 10, {{"HOST_COMMAND", kStale}})), "");
  EXPECT_EQ(Add(Said("world", 10, {{"HOST_COMMAND", kStale}}, "the host's last command holds")),
            "step 10: world: HOST_COMMAND stale (culprit: arbitrator, last heard 0.25 s ago): "
            "the host's last command holds");
}

TEST_F(FallbackLogTest, BlamesTheRoleThatSilencesTheOthers) {
  Add(Said("fusion", 12, {{"RADAR", kLost}}));
  Add(Said("acc", 12, {{"TRACK", kLost}}));
  EXPECT_EQ(log_.all().back().culprit, "radar");
}

TEST_F(FallbackLogTest, ForgetsWhatARoleHasLostOnceItIsSilentItself) {
  // GIVEN a fusion that lost the radar and then sent no further STATUS
  Add(Said("fusion", 12, {{"RADAR", kLost}}));
  // WHEN TRACK is lost later in another role
  Add(Said("acc", 40, {{"TRACK", kLost}}));
  // THEN the culprit is the fusion, not the radar
  EXPECT_EQ(log_.all().back().culprit, "fusion");
}

TEST_F(FallbackLogTest, MeasuresSilenceInTheTimeOfPeople) {
  runtime::FallbackLog fast(kStep_us, 20, kSteps);
  fast.Add(Said("fusion", 12, {{"RADAR", kLost}}));
  fast.Add(Said("acc", 40, {{"TRACK", kLost}}));  // 0.14 s later
  EXPECT_EQ(fast.all().back().culprit, "radar");
}

TEST_F(FallbackLogTest, TakesTheSilenceAfterTheLastStepForNoNews) {
  EXPECT_EQ(Add(Said("fusion", kSteps - 1, {{"RADAR", kLost}})), "");
  EXPECT_NE(Add(Said("fusion", kSteps - 2, {{"RADAR", kLost}})), "");
}

TEST_F(FallbackLogTest, ForgetsWhatThePredecessorOfAProcessHadLost) {
  Add(Said("fusion", 12, {{"RADAR", kLost}}));
  status_t next = Said("fusion", 13, {{"RADAR", status_t::INPUT_AWAITED}});
  next.instance = 2;
  EXPECT_EQ(Add(next), "");
  Add(Said("acc", 13, {{"TRACK", kLost}}));
  EXPECT_EQ(log_.all().back().culprit, "fusion");
  // When the new process receives RADAR again, the log reports this.
  next.input_state = {kOk};
  EXPECT_EQ(Add(next), "step 13: fusion: RADAR ok again");
}

TEST_F(FallbackLogTest, DoesNotSayThatAFallbackHasEndedBecauseItsProcessWasRestarted) {
  Add(Said("arbitrator", 30, {{"TRACK", kLost}}, "the human drives"));
  status_t next = Said("arbitrator", 0, {});
  next.instance = 2;
  for (const std::int8_t state :
       {status_t::WAITING, status_t::READY, status_t::FAILED, status_t::LEFT}) {
    next.state = state;
    EXPECT_EQ(Add(next), "");
  }
  EXPECT_EQ(Add(Said("arbitrator", 40, {{"TRACK", kLost}}, "the human drives")), "");
  EXPECT_EQ(Add(Said("arbitrator", 50, {{"TRACK", kOk}})),
            "step 50: arbitrator: TRACK ok again: as usual again");
}

TEST_F(FallbackLogTest, HasNoOpinionOfTheRecorderAndOfForeignPeers) {
  EXPECT_EQ(Add(Said("recorder", 12, {{"RADAR", kLost}})), "");
  EXPECT_EQ(Add(Said("pilot", 12, {{"RADAR", kLost}})), "");
  EXPECT_EQ(Add(Said("fusion", 12, {{"NO_CHANNEL", kLost}})), "");
}

TEST_F(FallbackLogTest, ShowsNoTerminalWhatItWouldObey) {
  const std::string said = Add(Said("world", 3, {}, "\x1b[2J\rall is well\n"));
  EXPECT_EQ(said.find_first_of("\x1b\r\n"), std::string::npos) << said;
  EXPECT_NE(said.find("all is well"), std::string::npos);
}

TEST_F(FallbackLogTest, KeepsTheFirstChangesAndCountsTheRest) {
  constexpr std::int64_t kMore = 5;
  const auto changes = static_cast<std::int64_t>(runtime::FallbackLog::kMaxKept) + kMore;
  for (std::int64_t step = 0; step < changes; ++step) {
    EXPECT_NE(Add(Said("fusion", step, {{"RADAR", step % 2 == 0 ? kLost : kOk}})), "");
  }
  EXPECT_EQ(log_.all().size(), runtime::FallbackLog::kMaxKept);
  EXPECT_EQ(log_.all().front().step, 0);
  EXPECT_EQ(log_.left_out(), kMore);
}

}  // namespace
}  // namespace fogline
