#include "tools/web/seat/open_request.h"

#include <gtest/gtest.h>

namespace fogline::web {
namespace {

class OpenRequestTest : public testing::Test {
 protected:
  /// A command of a step of 20 ms. @return whether a request has begun
  bool Hear(std::int64_t step, std::int8_t mode, std::int64_t run_id = 7) {
    arbitration_t command{};
    command.header = {.run_id = run_id, .step = step, .utime = 20'000 * step};
    command.mode = mode;
    return open_.Hear(command);
  }
  void ExpectRequest(std::int64_t since_step, bool begin_known) const {
    ASSERT_TRUE(open_.request());
    EXPECT_EQ(open_.request()->since_us, 20'000 * since_step);
    EXPECT_EQ(open_.request()->begin_known, begin_known);
  }

  OpenRequest open_;
};

TEST_F(OpenRequestTest, BeginsWithItsFirstStepAndANewOneBeginsAgain) {
  EXPECT_FALSE(Hear(0, arbitration_t::AUTOMATION));
  EXPECT_FALSE(open_.request());
  EXPECT_TRUE(Hear(1, arbitration_t::REQUEST));
  EXPECT_FALSE(Hear(2, arbitration_t::REQUEST));
  EXPECT_FALSE(Hear(3, arbitration_t::REQUEST_URGENT));
  EXPECT_FALSE(Hear(4, arbitration_t::HANDOVER));
  ExpectRequest(1, true);
  EXPECT_FALSE(Hear(5, arbitration_t::RECOVERING));
  EXPECT_FALSE(open_.request());
  Hear(6, arbitration_t::AUTOMATION);
  EXPECT_TRUE(Hear(7, arbitration_t::REQUEST));
  ExpectRequest(7, true);
}

TEST_F(OpenRequestTest, OfTheFirstStepHasAKnownBegin) {
  EXPECT_TRUE(Hear(0, arbitration_t::REQUEST));
  ExpectRequest(0, true);
}

TEST_F(OpenRequestTest, BeforeTheFirstCommandHasNoKnownBegin) {
  EXPECT_TRUE(Hear(500, arbitration_t::REQUEST));
  ExpectRequest(500, false);
}

TEST_F(OpenRequestTest, AfterMissingCommandsHasNoKnownBegin) {
  Hear(0, arbitration_t::AUTOMATION);
  EXPECT_TRUE(Hear(10, arbitration_t::REQUEST)) << "a gap of 0.2 s";
  ExpectRequest(10, true);
  Hear(20, arbitration_t::AUTOMATION);
  EXPECT_TRUE(Hear(31, arbitration_t::REQUEST));
  ExpectRequest(31, false);
}

TEST_F(OpenRequestTest, GoesOnBehindEmergencyBraking) {
  Hear(0, arbitration_t::AUTOMATION);
  Hear(1, arbitration_t::REQUEST);
  EXPECT_FALSE(Hear(2, arbitration_t::EMERGENCY_BRAKING));
  EXPECT_FALSE(Hear(100, arbitration_t::REQUEST_URGENT));
  ExpectRequest(1, true);
}

TEST_F(OpenRequestTest, ThatBeginsBehindEmergencyBrakingHasNoKnownBegin) {
  Hear(0, arbitration_t::AUTOMATION);
  for (std::int64_t step = 1; step < 50; ++step) Hear(step, arbitration_t::EMERGENCY_BRAKING);
  EXPECT_TRUE(Hear(50, arbitration_t::REQUEST));
  ExpectRequest(50, false);
}

TEST_F(OpenRequestTest, IgnoresOlderCommandsAndEndsWithTheRun) {
  Hear(0, arbitration_t::AUTOMATION);
  Hear(2, arbitration_t::REQUEST);
  EXPECT_FALSE(Hear(1, arbitration_t::AUTOMATION));
  ExpectRequest(2, true);
  EXPECT_FALSE(Hear(0, arbitration_t::AUTOMATION, 8));
  EXPECT_FALSE(open_.request());
  EXPECT_TRUE(Hear(1, arbitration_t::REQUEST, 8));
}

TEST_F(OpenRequestTest, BeginsAgainIfTheRunIsPlayedAgain) {
  Hear(0, arbitration_t::AUTOMATION);
  Hear(9, arbitration_t::REQUEST);
  EXPECT_FALSE(Hear(0, arbitration_t::AUTOMATION));
  EXPECT_FALSE(open_.request());
  EXPECT_TRUE(Hear(1, arbitration_t::REQUEST));
  ExpectRequest(1, true);
}

TEST_F(OpenRequestTest, HasAKnownBeginHoweverLongAStepIs) {
  arbitration_t command{};
  for (const std::int64_t step : {0, 1, 2}) {
    command.header = {.run_id = 7, .step = step, .utime = 1'000'000 * step};
    command.mode = step < 2 ? arbitration_t::AUTOMATION : arbitration_t::REQUEST;
    open_.Hear(command);
  }
  ASSERT_TRUE(open_.request());
  EXPECT_TRUE(open_.request()->begin_known);
}

}  // namespace
}  // namespace fogline::web
