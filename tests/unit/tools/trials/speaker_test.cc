#include "tools/trials/speaker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/wire.h"

namespace fogline::trials {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

trial_t Base() {
  trial_t base{};
  base.participant = 3;
  base.trial = 2;
  base.attempt = 1;
  return base;
}

TEST(SpeakerTest, RefusesFactsThatTheRecorderWouldIgnore) {
  trial_t base = Base();
  base.experiment = std::string(101, 'x');
  EXPECT_THROW(Speaker("memq://", 7, {}, base), std::runtime_error);
}

TEST(SpeakerTest, CutsAMarkerBetweenTwoCharacters) {
  Speaker speaker("memq://", 7, {}, Base());
  std::string letters = "x";
  for (int i = 0; i < 250; ++i) letters += "\u00e4";  // two bytes each
  speaker.Mark(letters);
  const std::vector<trial_t> facts = speaker.End();
  ASSERT_EQ(facts.size(), 2U);  // BEGIN comes first
  EXPECT_EQ(facts[1].text, letters.substr(0, 499));
}

TEST(SpeakerTest, KeepsAnEarlyMarkerUntilTheRecorderListens) {
  const std::string url = runtime::FreshMulticastUrl();
  runtime::Bus bus(url);
  std::vector<std::int8_t> kinds;
  bus.Subscribe(ChannelOf<trial_t>().name, [&kinds](runtime::Arrival& arrival) {
    if (const auto* fact = arrival.As<trial_t>()) kinds.push_back(fact->kind);
  });
  Speaker speaker(url, 7, {}, Base());
  speaker.Mark("early");
  for (int i = 0; i < 10; ++i) bus.Wait(std::chrono::milliseconds(10));
  EXPECT_THAT(kinds, IsEmpty());
  truth_t truth{};
  truth.header.run_id = 7;
  std::vector<std::uint8_t> bytes;
  runtime::Encode(truth, bytes);
  const TimePoint end = Clock::now() + std::chrono::seconds(60);
  while (kinds.size() < 2 && Clock::now() < end) {  // the speaker may begin to listen late
    bus.Publish(ChannelOf<truth_t>().name, bytes);
    bus.Wait(std::chrono::milliseconds(10));
  }
  EXPECT_THAT(kinds, ElementsAre(trial_t::BEGIN, trial_t::MARKER));
}

TEST(SpeakerTest, TheTimeOfALateMarkerIsNotThatOfTheBeginning) {
  Speaker speaker("memq://", 7, {}, Base());
  const std::int64_t made_us = UnixMicros();
  while (UnixMicros() == made_us) {
  }
  speaker.Mark("late");
  const std::vector<trial_t> facts = speaker.End();
  ASSERT_EQ(facts.size(), 2U);
  EXPECT_LE(facts[0].unix_us, made_us);
  EXPECT_GT(facts[1].unix_us, made_us);
}

TEST(SpeakerTest, EndsWithTheBeginningEvenIfNoStepHasCome) {
  Speaker speaker("memq://", 7, {}, Base());
  const std::int64_t made_us = UnixMicros();
  const std::vector<trial_t> facts = speaker.End();
  ASSERT_EQ(facts.size(), 1U);
  EXPECT_LE(facts[0].unix_us, made_us);
  EXPECT_EQ(facts[0].kind, trial_t::BEGIN);
  EXPECT_EQ(facts[0].trial, 2);
}

}  // namespace
}  // namespace fogline::trials
