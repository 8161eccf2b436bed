// TakeOverLog of a log that lacks the first commands of its run.
#include "services/decision/take_over/take_over_log.h"

#include <cstdint>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "tests/unit/services/decision/take_over/logged_commands.h"

namespace fogline::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(LateTakeOverLogTest, HasNoRequestThatBeganBeforeTheFirstCommand) {
  take_over::TakeOverLog log;
  Add(log, Command(7, arbitration_t::REQUEST));
  Add(log, Command(8, arbitration_t::HANDOVER));
  Add(log, Command(9, arbitration_t::RECOVERING, -3));
  Add(log, Command(10, arbitration_t::RECOVERING, -4));
  Add(log, Command(11, arbitration_t::HUMAN));
  Add(log, Command(12, arbitration_t::AUTOMATION));
  EXPECT_THAT(log.requests(), IsEmpty());
  EXPECT_TRUE(log.BeganInRequest());
  EXPECT_THAT(Texts(log), ElementsAre("first command of the log", "acknowledgement",
                                      "transfer to the human", "first effective input of the human",
                                      "human recovered", "transfer to the automation"));
  EXPECT_EQ(take_over::NameOfMode(log.entries()[0].from), "DEMAND");
  EXPECT_TRUE(log.entries()[0].first);
  EXPECT_FALSE(log.entries()[1].first);
  Add(log, Command(20, arbitration_t::REQUEST));
  EXPECT_THAT(log.requests(), ElementsAre(take_over::TakeOverRequest{.requested = 20}));
}

TEST(LateTakeOverLogTest, SaysFromWhichStepOnAnEventAfterAGapMayHaveHappened) {
  take_over::TakeOverLog log;
  Add(log, Command(7, arbitration_t::AUTOMATION));
  Add(log, Command(8, arbitration_t::REQUEST));
  Add(log, Command(12, arbitration_t::HANDOVER));
  std::vector<std::int64_t> earliest;
  for (const take_over::TakeOverEntry& entry : log.entries())
    earliest.push_back(entry.earliest_step);
  EXPECT_THAT(earliest, ElementsAre(7, 8, 9));
}

TEST(LateTakeOverLogTest, DoesNotTakeARequestThatBeginsInAGapForTheOneBefore) {
  for (const std::int8_t first_heard : {arbitration_t::REQUEST_URGENT, arbitration_t::HANDOVER,
                                        arbitration_t::RECOVERING, arbitration_t::MRM_COMFORT}) {
    take_over::TakeOverLog log;
    Add(log, Command(0, arbitration_t::AUTOMATION));
    Add(log, Command(1, arbitration_t::REQUEST));
    Add(log, Command(2, arbitration_t::AUTOMATION));
    const std::vector<take_over::TakeOverRequest> before = log.requests();
    Add(log, Command(9, first_heard, -3));
    Add(log, Command(10, arbitration_t::RECOVERING, -6));
    Add(log, Command(11, arbitration_t::HUMAN, -6));
    EXPECT_EQ(log.requests(), before) << take_over::NameOfMode(first_heard);
    Add(log, Command(12, arbitration_t::AUTOMATION));
    Add(log, Command(13, arbitration_t::REQUEST));
    Add(log, Command(14, arbitration_t::HANDOVER));
    EXPECT_EQ(log.requests().back(),
              (take_over::TakeOverRequest{.requested = 13, .acknowledged = 14}));
  }
}

TEST(LateTakeOverLogTest, KeepsTheTimesOfARequestBeforeAGapInWhichTheNextOneBegins) {
  take_over::TakeOverLog answered;
  Add(answered, Command(0, arbitration_t::AUTOMATION));
  Add(answered, Command(1, arbitration_t::REQUEST));
  Add(answered, Command(2, arbitration_t::HANDOVER));
  std::vector<take_over::TakeOverRequest> before = answered.requests();
  Add(answered, Command(900, arbitration_t::REQUEST_URGENT));
  EXPECT_EQ(answered.requests(), before);

  take_over::TakeOverLog driven;
  Add(driven, Command(0, arbitration_t::AUTOMATION));
  Add(driven, Command(1, arbitration_t::REQUEST));
  Add(driven, Command(2, arbitration_t::RECOVERING));
  Add(driven, Command(3, arbitration_t::HUMAN));
  before = driven.requests();
  Add(driven, Command(900, arbitration_t::RECOVERING));
  Add(driven, Command(901, arbitration_t::RECOVERING, -6));
  EXPECT_EQ(driven.requests(), before);
}

TEST(LateTakeOverLogTest, SaysThatAnInputMayHaveBeenEffectiveBeforeIfOffersAreMissing) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION));
  Add(log, Command(1, arbitration_t::REQUEST));
  Add(log, Command(2, arbitration_t::HANDOVER));
  log.Add(Command(3, arbitration_t::RECOVERING, -3), std::nullopt);
  log.Add(Command(4, arbitration_t::RECOVERING, -3), std::nullopt);
  Add(log, Command(5, arbitration_t::RECOVERING, -3));
  const take_over::TakeOverEntry& last = log.entries().back();
  EXPECT_EQ(last.logged, "first effective input of the human");
  EXPECT_EQ(last.step, 5);
  EXPECT_EQ(last.earliest_step, 3);
}

TEST(LateTakeOverLogTest, KnowsTheStateOfALateLogWhenEmergencyBrakingHidesItNoLonger) {
  take_over::TakeOverLog log;
  Add(log, Emergency(7, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Emergency(8, arbitration_t::EMERGENCY_BRAKING));
  EXPECT_FALSE(log.BeganInRequest());
  Add(log, Command(9, arbitration_t::REQUEST_URGENT));
  EXPECT_TRUE(log.BeganInRequest());
  Add(log, Emergency(10, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Command(11, arbitration_t::REQUEST_URGENT));
  EXPECT_THAT(log.requests(), IsEmpty());
  EXPECT_THAT(Texts(log), ElementsAre("first command of the log", "emergency braking ends",
                                      "emergency braking begins", "emergency braking ends"));
}

TEST(LateTakeOverLogTest, HasARequestOfALateLogAfterAWarning) {
  take_over::TakeOverLog log;
  Add(log, Emergency(7, arbitration_t::COLLISION_WARNING));
  Add(log, Command(8, arbitration_t::REQUEST));
  EXPECT_FALSE(log.BeganInRequest());
  EXPECT_THAT(log.requests(), ElementsAre(take_over::TakeOverRequest{.requested = 8}));
}

TEST(LateTakeOverLogTest, HasAManoeuvreOfALateLogAfterEmergencyBraking) {
  take_over::TakeOverLog log;
  Add(log, Emergency(7, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Command(8, arbitration_t::MRM_EMERGENCY));
  EXPECT_TRUE(log.BeganInRequest());
  EXPECT_THAT(Texts(log), ElementsAre("first command of the log", "manoeuvre begins",
                                      "emergency braking ends"));
}

TEST(LateTakeOverLogTest, SeesThatARunHasRequestsInALateLogThatBeginsWithTheDriver) {
  take_over::TakeOverLog log;
  Add(log, Command(7, arbitration_t::HUMAN));
  Add(log, Command(8, arbitration_t::MRM_COMFORT));
  Add(log, Command(9, arbitration_t::RECOVERING));
  Add(log, Emergency(10, arbitration_t::EMERGENCY_BRAKING, 1));
  Add(log, Command(11, arbitration_t::RECOVERING));
  EXPECT_THAT(Texts(log), ElementsAre("first command of the log", "manoeuvre: comfortable stop",
                                      "human ends manoeuvre", "first effective input of the human",
                                      "emergency braking begins", "emergency braking ends"));
  take_over::TakeOverLog shared;
  Add(shared, Shared(7, arbitration_t::HUMAN, 0.3));
  Add(shared, Shared(8, arbitration_t::EMERGENCY_BRAKING, 0.3));
  Add(shared, Shared(9, arbitration_t::HUMAN, 0.3));
  EXPECT_THAT(Texts(shared), ElementsAre("first command of the log", "emergency braking begins",
                                         "emergency braking ends"));
}

TEST(LateTakeOverLogTest, TakesNoRampForAChangeOfState) {
  take_over::TakeOverLog log;
  Add(log, Shared(7, arbitration_t::AUTOMATION, 0.7));
  Add(log, Shared(8, arbitration_t::EMERGENCY_BRAKING, 0.55));
  Add(log, Shared(9, arbitration_t::AUTOMATION, 0.3));
  EXPECT_THAT(Texts(log), ElementsAre("first command of the log", "emergency braking begins",
                                      "transfer to the automation", "emergency braking ends"));
}

TEST(LateTakeOverLogTest, HasTheTransfersOfALateLog) {
  take_over::TakeOverLog log;
  Add(log, Emergency(7, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Emergency(8, arbitration_t::EMERGENCY_BRAKING, 1));
  Add(log, Command(9, arbitration_t::HUMAN));
  Add(log, Command(10, arbitration_t::AUTOMATION));
  EXPECT_FALSE(log.BeganInRequest());
  EXPECT_THAT(Transfers(log), ElementsAre(8, 10));
  EXPECT_EQ(log.entries()[1].from, log.entries()[1].to);
}

}  // namespace
}  // namespace fogline::test
