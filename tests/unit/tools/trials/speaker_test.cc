#include "tools/trials/speaker.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace fogline::trials {
namespace {

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

}  // namespace
}  // namespace fogline::trials
