#include "services/arbitrator/take_over_log.h"

#include <cstdint>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

arbitration_t Command(std::int64_t step, std::int8_t mode, double acceleration_mps2 = 0) {
  arbitration_t command{};
  command.header.step = step;
  command.header.utime = step * 100'000;
  command.mode = mode;
  command.acceleration_mps2 = acceleration_mps2;
  return command;
}

std::vector<std::string_view> Texts(const TakeOverLog& log) {
  std::vector<std::string_view> texts;
  for (const TakeOverEntry& entry : log.entries()) texts.push_back(entry.logged);
  return texts;
}

TEST(TakeOverLogTest, TellsARequestFromItsBeginningToTheDriversFirstInput) {
  TakeOverLog log;
  log.Add(Command(0, arbitration_t::AUTOMATION, 0.3));
  log.Add(Command(1, arbitration_t::REQUEST));
  log.Add(Command(2, arbitration_t::REQUEST_URGENT));
  log.Add(Command(3, arbitration_t::HANDOVER, 0.3));
  log.Add(Command(4, arbitration_t::RECOVERING, 0.305));
  log.Add(Command(5, arbitration_t::RECOVERING, 0.315));
  log.Add(Command(6, arbitration_t::HUMAN));
  log.Add(Command(7, arbitration_t::AUTOMATION));
  EXPECT_THAT(Texts(log), ElementsAre("activation of the automation", "request to take over",
                                      "escalation", "acknowledgement", "transfer to the driver",
                                      "first effective input of the driver", "driver recovered",
                                      "return to automation"));
  EXPECT_THAT(
      log.requests(),
      ElementsAre(TakeOverRequest{
          .requested = 1, .escalated = 2, .acknowledged = 3, .transferred = 4, .effective = 5}));
  EXPECT_EQ(log.entries()[5].utime, 500'000);
}

TEST(TakeOverLogTest, TellsOfAManoeuvreThatEndsInTheLock) {
  TakeOverLog log;
  log.Add(Command(0, arbitration_t::REQUEST));
  log.Add(Command(1, arbitration_t::MRM_COMFORT));
  log.Add(Command(2, arbitration_t::MRM_EMERGENCY));
  log.Add(Command(3, arbitration_t::MRM_DONE));
  EXPECT_THAT(Texts(log),
              ElementsAre("activation of the automation", "request to take over",
                          "comfortable manoeuvre", "emergency manoeuvre", "standstill, locked"));
  EXPECT_THAT(log.requests(),
              ElementsAre(TakeOverRequest{.requested = 0, .manoeuvre = 1, .standstill = 3}));
}

TEST(TakeOverLogTest, HasTransfersAndNoRequestsWhereTheDriverNeedNotBeAsked) {
  TakeOverLog log;
  log.Add(Command(0, arbitration_t::AUTOMATION, 1));
  log.Add(Command(1, arbitration_t::HUMAN, 1));
  log.Add(Command(2, arbitration_t::HUMAN, 1.5));
  log.Add(Command(3, arbitration_t::AUTOMATION, 1));
  log.Add(Command(4, arbitration_t::MINIMAL_RISK, -1));
  EXPECT_THAT(Texts(log), ElementsAre("activation of the automation", "transfer to the driver",
                                      "first effective input of the driver", "return to automation",
                                      "manoeuvre begins: inputs have failed"));
  EXPECT_THAT(log.requests(), IsEmpty());
}

TEST(TakeOverLogTest, DoesNotCountAnInputOfADriverWhomNobodyAskedForTheLastRequest) {
  TakeOverLog log;
  log.Add(Command(0, arbitration_t::REQUEST));
  log.Add(Command(1, arbitration_t::HUMAN));  // the automation has failed
  log.Add(Command(2, arbitration_t::HUMAN, 2));
  EXPECT_THAT(log.requests(), ElementsAre(TakeOverRequest{.requested = 0}));
  EXPECT_THAT(log.entries(), SizeIs(4));
}

TEST(TakeOverLogTest, GivesAModeThatIsNoneANameOfItsOwn) {
  EXPECT_EQ(NameOfMode(arbitration_t::MINIMAL_RISK), "MINIMAL_RISK");
  EXPECT_EQ(NameOfMode(arbitration_t::HUMAN), "MANUAL");
  EXPECT_EQ(NameOfMode(77), "UNKNOWN");
}

}  // namespace
}  // namespace fogline
