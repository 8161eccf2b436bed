#include "services/decision/take_over/take_over_log.h"

#include <cstdint>
#include <optional>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "tests/unit/services/decision/take_over/logged_commands.h"

namespace fogline::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(TakeOverLogTest, TellsARequestFromItsBeginningToTheDriversFirstInput) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION, 0.3));
  Add(log, Command(1, arbitration_t::REQUEST));
  Add(log, Command(2, arbitration_t::REQUEST_URGENT));
  Add(log, Command(3, arbitration_t::HANDOVER, 0.3));
  Add(log, Command(4, arbitration_t::RECOVERING, 0.305));
  Add(log, Command(5, arbitration_t::RECOVERING, 0.315));
  Add(log, Command(6, arbitration_t::HUMAN));
  Add(log, Command(7, arbitration_t::AUTOMATION));
  EXPECT_THAT(Texts(log), ElementsAre("activation of the automation", "request to take over",
                                      "urgent request to take over", "acknowledgement",
                                      "transfer to the human", "first effective input of the human",
                                      "human recovered", "transfer to the automation"));
  EXPECT_THAT(
      log.requests(),
      ElementsAre(take_over::TakeOverRequest{
          .requested = 1, .escalated = 2, .acknowledged = 3, .transferred = 4, .effective = 5}));
  EXPECT_EQ(log.entries()[5].utime, 500'000);
}

TEST(TakeOverLogTest, KeepsItsRequestsWhenItsEntriesAreDropped) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION));
  Add(log, Command(1, arbitration_t::REQUEST));
  log.DropEntries();
  EXPECT_THAT(log.entries(), IsEmpty());
  Add(log, Command(2, arbitration_t::HANDOVER));
  EXPECT_THAT(Texts(log), ElementsAre("acknowledgement"));
  EXPECT_THAT(log.requests(),
              ElementsAre(take_over::TakeOverRequest{.requested = 1, .acknowledged = 2}));
}

TEST(TakeOverLogTest, HasTheModeThatEmergencyBrakingHides) {
  take_over::TakeOverLog log;
  EXPECT_EQ(log.mode(), arbitration_t::AUTOMATION);
  Add(log, Command(0, arbitration_t::REQUEST));
  Add(log, Command(1, arbitration_t::EMERGENCY_BRAKING));
  EXPECT_EQ(log.mode(), arbitration_t::REQUEST);
  Add(log, Command(2, arbitration_t::HANDOVER));
  EXPECT_EQ(log.mode(), arbitration_t::HANDOVER);
}

TEST(TakeOverLogTest, EndsARequestOrARecoveryWhenACollisionWarningReplacesTheModeAfterIt) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::REQUEST));
  Add(log, Command(1, arbitration_t::COLLISION_WARNING));
  EXPECT_EQ(log.mode(), arbitration_t::AUTOMATION);
  Add(log, Command(2, arbitration_t::RECOVERING));
  Add(log, Command(3, arbitration_t::COLLISION_WARNING));
  EXPECT_EQ(log.mode(), arbitration_t::HUMAN);
}

TEST(TakeOverLogTest, TellsThatTheHumanDrivesFromTheFirstStepOn) {
  take_over::TakeOverLog log;
  arbitration_t first = Command(0, arbitration_t::HUMAN);
  first.lambda_human = 1;
  Add(log, first);
  EXPECT_THAT(Texts(log), ElementsAre("activation of the automation", "transfer to the human"));
}

TEST(TakeOverLogTest, TellsOfAManoeuvreThatEndsInTheLock) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::REQUEST));
  Add(log, Command(1, arbitration_t::MRM_COMFORT));
  Add(log, Command(2, arbitration_t::MRM_EMERGENCY));
  Add(log, Command(3, arbitration_t::MRM_DONE));
  EXPECT_THAT(Texts(log), ElementsAre("activation of the automation", "request to take over",
                                      "manoeuvre: comfortable stop", "manoeuvre: emergency stop",
                                      "standstill, locked"));
  EXPECT_THAT(log.requests(), ElementsAre(take_over::TakeOverRequest{
                                  .requested = 0, .manoeuvre = 1, .standstill = 3}));
}

TEST(TakeOverLogTest, HasTransfersAndNoRequestsWhereTheDriverNeedNotBeAsked) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION, 1));
  Add(log, Command(1, arbitration_t::HUMAN, 1));
  Add(log, Command(2, arbitration_t::HUMAN, 1.5));
  Add(log, Command(3, arbitration_t::AUTOMATION, 1));
  Add(log, Command(4, arbitration_t::MINIMAL_RISK, -1));
  EXPECT_THAT(Texts(log),
              ElementsAre("activation of the automation", "transfer to the human",
                          "first effective input of the human", "transfer to the automation",
                          "manoeuvre begins: inputs have failed"));
  EXPECT_THAT(log.requests(), IsEmpty());
}

TEST(TakeOverLogTest, DoesNotCountAnUnrequestedInputForTheLastRequest) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::REQUEST));
  Add(log, Command(1, arbitration_t::HUMAN));  // the automation has failed, so the human drives
  Add(log, Command(2, arbitration_t::HUMAN, 2));
  EXPECT_THAT(log.requests(), ElementsAre(take_over::TakeOverRequest{.requested = 0}));
  EXPECT_THAT(log.entries(), SizeIs(4));
}

TEST(TakeOverLogTest, TellsATransferWhereARampPassesTheHalfAndNotWhereItBegins) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::REQUEST, 0.3));
  Add(log, Command(1, arbitration_t::HANDOVER, 0.3));
  log.Add(Shared(2, arbitration_t::RECOVERING, 0.4, 0.3), 0.3);
  log.Add(Shared(3, arbitration_t::RECOVERING, 0.8, 0.3), 0.3);
  log.Add(Shared(4, arbitration_t::HUMAN, 1, 0.5), 0.5);
  log.Add(Shared(5, arbitration_t::AUTOMATION, 0.6), 0);
  log.Add(Shared(6, arbitration_t::AUTOMATION, 0.2), 0);
  EXPECT_THAT(Texts(log),
              ElementsAre("activation of the automation", "request to take over", "acknowledgement",
                          "human takes part", "transfer to the human", "human recovered",
                          "first effective input of the human", "human is released",
                          "transfer to the automation"));
  EXPECT_THAT(Transfers(log), ElementsAre(3, 6));
  EXPECT_THAT(log.requests(),
              ElementsAre(take_over::TakeOverRequest{
                  .requested = 0, .acknowledged = 1, .transferred = 3, .effective = 4}));
}

TEST(TakeOverLogTest, TakesNothingThatTheAutomationDoesForAnInputOfADriverWithoutAShare) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::REQUEST));
  Add(log, Command(1, arbitration_t::HANDOVER));
  log.Add(Shared(2, arbitration_t::RECOVERING, 0, -2), 1);
  log.Add(Shared(3, arbitration_t::RECOVERING, 0.1, -3), 0.09);
  log.Add(Shared(4, arbitration_t::HUMAN, 0.1, -3), std::nullopt);
  EXPECT_THAT(Transfers(log), IsEmpty());
  EXPECT_THAT(log.requests(),
              ElementsAre(take_over::TakeOverRequest{.requested = 0, .acknowledged = 1}));
  // The human has a tenth of the authority. So the offer of 0.11 m/s2 changes the command by
  // 0.011 m/s2. This is above kEffectiveInput_mps2, so the input is effective.
  log.Add(Shared(5, arbitration_t::HUMAN, 0.1, -3), 0.11);
  EXPECT_THAT(log.requests(), ElementsAre(take_over::TakeOverRequest{
                                  .requested = 0, .acknowledged = 1, .effective = 5}));
  EXPECT_THAT(Transfers(log), IsEmpty());
}

TEST(TakeOverLogTest, GivesAModeThatIsNoneANameOfItsOwn) {
  EXPECT_EQ(take_over::NameOfMode(arbitration_t::MINIMAL_RISK), "MINIMAL_RISK");
  EXPECT_EQ(take_over::NameOfMode(arbitration_t::HUMAN), "MANUAL");
  EXPECT_EQ(take_over::NameOfMode(77), "UNKNOWN");
}

// ---- emergency braking --------------------------------------------------------------------------

TEST(TakeOverLogTest, NamesBeginAndEndOfEmergencyBraking) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION));
  Add(log, Emergency(1, arbitration_t::COLLISION_WARNING));
  Add(log, Emergency(2, arbitration_t::COLLISION_WARNING));
  Add(log, Emergency(3, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Emergency(4, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Emergency(5, arbitration_t::COLLISION_WARNING));
  Add(log, Command(6, arbitration_t::AUTOMATION));
  EXPECT_THAT(Texts(log), ElementsAre("activation of the automation", "collision warning begins",
                                      "emergency braking begins", "emergency braking ends",
                                      "collision warning begins", "collision warning ends"));
  EXPECT_EQ(log.entries()[2].step, 3);
  EXPECT_EQ(take_over::NameOfMode(log.entries()[2].from), "COLLISION_WARNING");
  EXPECT_EQ(take_over::NameOfMode(log.entries()[2].to), "EMERGENCY_BRAKING");
  EXPECT_THAT(Transfers(log), IsEmpty());
}

TEST(TakeOverLogTest, TellsATransferThatEmergencyBrakingHides) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION));
  Add(log, Emergency(1, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Emergency(2, arbitration_t::EMERGENCY_BRAKING, 1));
  Add(log, Command(3, arbitration_t::HUMAN, -9));
  EXPECT_THAT(Texts(log), ElementsAre("activation of the automation", "emergency braking begins",
                                      "transfer to the human", "emergency braking ends"));
  EXPECT_THAT(Transfers(log), ElementsAre(2));
}

TEST(TakeOverLogTest, TakesARequestBehindEmergencyBrakingForTheSame) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION));
  Add(log, Command(1, arbitration_t::REQUEST));
  Add(log, Emergency(2, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Emergency(3, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Command(4, arbitration_t::REQUEST));
  Add(log, Emergency(5, arbitration_t::EMERGENCY_BRAKING));
  Add(log, Command(6, arbitration_t::HANDOVER));
  EXPECT_THAT(Texts(log),
              ElementsAre("activation of the automation", "request to take over",
                          "emergency braking begins", "emergency braking ends",
                          "emergency braking begins", "acknowledgement", "emergency braking ends"));
  EXPECT_THAT(log.requests(),
              ElementsAre(take_over::TakeOverRequest{.requested = 1, .acknowledged = 6}));
}

TEST(TakeOverLogTest, TakesARequestThatBeginsBehindEmergencyBrakingNotForTheOneBefore) {
  for (const std::int8_t next : {arbitration_t::MRM_EMERGENCY, arbitration_t::REQUEST_URGENT}) {
    take_over::TakeOverLog log;
    Add(log, Command(0, arbitration_t::AUTOMATION));
    Add(log, Command(1, arbitration_t::REQUEST));
    Add(log, Command(2, arbitration_t::HANDOVER));
    Add(log, Command(3, arbitration_t::RECOVERING));
    Add(log, Command(4, arbitration_t::HUMAN));
    Add(log, Command(5, arbitration_t::AUTOMATION));
    const auto before = log.requests();
    Add(log, Emergency(6, arbitration_t::EMERGENCY_BRAKING));
    Add(log, Command(7, next));
    EXPECT_EQ(log.requests(), before);
  }
}

TEST(TakeOverLogTest, SaysWhoHasAcknowledged) {
  const take_over::TakeOverEntry answer{
      .from = arbitration_t::REQUEST, .to = arbitration_t::HANDOVER, .logged = "acknowledgement"};
  const PersonSection drives{.drives = true};
  EXPECT_EQ(take_over::TextOf(answer, drives), "acknowledgement by the person");
  EXPECT_EQ(take_over::TextOf(answer, {}), "acknowledgement (driver model)");
  const take_over::TakeOverEntry other{
      .from = arbitration_t::HANDOVER, .to = arbitration_t::HANDOVER, .logged = "something"};
  EXPECT_EQ(take_over::TextOf(other, drives), "something");
}

TEST(TakeOverLogTest, SaysThatAPersonHasOverridden) {
  const PersonSection drives{.drives = true};
  const PersonSection overrides{.drives = true, .override_by = OverrideBy::kBrake};
  for (const std::int8_t from :
       {arbitration_t::AUTOMATION, arbitration_t::REQUEST, arbitration_t::REQUEST_URGENT}) {
    const take_over::TakeOverEntry entry{
        .from = from, .to = arbitration_t::RECOVERING, .logged = "transfer to the human"};
    EXPECT_EQ(take_over::TextOf(entry, overrides), "override by the person");
    EXPECT_EQ(take_over::TextOf(entry, drives), "transfer to the human");
  }
  const take_over::TakeOverEntry answered{.from = arbitration_t::HANDOVER,
                                          .to = arbitration_t::RECOVERING,
                                          .logged = "transfer to the human"};
  EXPECT_EQ(take_over::TextOf(answered, overrides), "transfer to the human");
}

TEST(TakeOverLogTest, MakesNoRequestOfAnOverrideAndLeavesTheLastOneAsItWas) {
  take_over::TakeOverLog log;
  const auto override_at = [&](std::int64_t step) {
    Add(log, Command(step, arbitration_t::AUTOMATION));
    Add(log, Command(step + 1, arbitration_t::RECOVERING, -3));
    Add(log, Command(step + 2, arbitration_t::HUMAN, -3));
    Add(log, Command(step + 3, arbitration_t::AUTOMATION));
  };
  override_at(0);
  EXPECT_THAT(log.requests(), IsEmpty());
  EXPECT_THAT(Texts(log), ElementsAre("activation of the automation", "transfer to the human",
                                      "first effective input of the human", "human recovered",
                                      "transfer to the automation"));
  EXPECT_THAT(Transfers(log), ElementsAre(1, 3));
  Add(log, Command(10, arbitration_t::REQUEST));
  Add(log, Command(11, arbitration_t::HANDOVER));
  Add(log, Command(12, arbitration_t::RECOVERING, -1));
  Add(log, Command(13, arbitration_t::HUMAN, -1));
  const take_over::TakeOverRequest answered{
      .requested = 10, .acknowledged = 11, .transferred = 12, .effective = 12};
  ASSERT_THAT(log.requests(), ElementsAre(answered));
  override_at(20);
  EXPECT_THAT(log.requests(), ElementsAre(answered));
}

TEST(TakeOverLogTest, LeavesARequestAsItWasWhenThePersonIsGoneAfterIt) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION));
  Add(log, Command(10, arbitration_t::REQUEST));
  Add(log, Command(11, arbitration_t::HANDOVER));
  Add(log, Command(12, arbitration_t::RECOVERING, -1));
  const take_over::TakeOverRequest answered{
      .requested = 10, .acknowledged = 11, .transferred = 12, .effective = 12};
  ASSERT_THAT(log.requests(), ElementsAre(answered));
  Add(log, Command(13, arbitration_t::MRM_COMFORT, -1.5));
  Add(log, Command(14, arbitration_t::RECOVERING, -3));
  Add(log, Command(15, arbitration_t::HUMAN, -3));
  EXPECT_THAT(log.requests(), ElementsAre(answered));
  EXPECT_THAT(Transfers(log), ElementsAre(12, 13, 14));
  const take_over::TakeOverEntry gone = log.entries()[5];
  EXPECT_EQ(gone.step, 13);
  EXPECT_EQ(take_over::TextOf(gone, {.drives = true}), "manoeuvre begins: person gone");
}

TEST(TakeOverLogTest, TakesAnOverrideDuringARequestForItsAnswer) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION));
  Add(log, Command(1, arbitration_t::REQUEST));
  Add(log, Command(2, arbitration_t::RECOVERING, -3));
  EXPECT_THAT(log.requests(),
              ElementsAre(take_over::TakeOverRequest{
                  .requested = 1, .acknowledged = 2, .transferred = 2, .effective = 2}));
}

TEST(TakeOverLogTest, TakesAnOverrideBehindEmergencyBrakingForTheSame) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION));
  Add(log, Command(1, arbitration_t::RECOVERING, -3));
  Add(log, Emergency(2, arbitration_t::EMERGENCY_BRAKING, 1));
  Add(log, Command(3, arbitration_t::RECOVERING, -3));
  Add(log, Command(4, arbitration_t::HUMAN, -3));
  EXPECT_THAT(Texts(log),
              ElementsAre("activation of the automation", "transfer to the human",
                          "first effective input of the human", "emergency braking begins",
                          "emergency braking ends", "human recovered"));
}

TEST(TakeOverLogTest, TakesTheStateBehindEmergencyBrakingForTheSameAfterAnOverride) {
  take_over::TakeOverLog log;
  Add(log, Command(0, arbitration_t::AUTOMATION));
  Add(log, Command(1, arbitration_t::RECOVERING, -3));
  Add(log, Command(2, arbitration_t::AUTOMATION));
  Add(log, Emergency(3, arbitration_t::EMERGENCY_BRAKING, 0.6));
  Add(log, Command(4, arbitration_t::RECOVERING, -3));
  EXPECT_THAT(Texts(log),
              ElementsAre("activation of the automation", "transfer to the human",
                          "first effective input of the human", "transfer to the automation",
                          "transfer to the human", "emergency braking begins", "human takes part",
                          "first effective input of the human", "emergency braking ends"));
}

}  // namespace
}  // namespace fogline::test
