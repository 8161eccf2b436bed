#include "services/runtime/wire/scenario_parts.h"

#include <gtest/gtest.h>

#include "common/text.h"

namespace fogline {
namespace {

std::string LongText() {
  std::string text;
  for (int i = 0; text.size() < 5 * runtime::kPartBytes + 7; ++i) text += std::to_string(i) + ",";
  return text;
}

TEST(ScenarioPartsTest, PutsATextTogetherFromPartsInAnyOrderWithRepetitions) {
  const std::string text = LongText();
  const std::vector<std::string> parts = runtime::SplitScenario(text);
  runtime::ScenarioParts inbox;
  for (std::size_t i = parts.size(); i-- > 0;) {
    EXPECT_FALSE(inbox.Complete());
    EXPECT_TRUE(
        inbox.Add(runtime::MakeRunPart(1, run_t::PREPARE, 0, runtime::HashOf(text), parts, i)));
    EXPECT_TRUE(
        inbox.Add(runtime::MakeRunPart(1, run_t::PREPARE, 0, runtime::HashOf(text), parts, i)));
    if (i > 0) {
      EXPECT_EQ(inbox.FirstMissing(), 0);
    }
  }
  ASSERT_TRUE(inbox.Complete());
  EXPECT_EQ(inbox.Text(), text);
  EXPECT_TRUE(inbox.HashHolds());
}

TEST(ScenarioPartsTest, CutsNoCharacterInTwo) {
  for (const std::string character : {"\u00e4", "\u20ac", "\U0001f697"}) {  // 2, 3 and 4 bytes
    for (std::size_t before = 0; before < character.size(); ++before) {
      std::string text(before, 'x');
      while (text.size() < 3 * runtime::kPartBytes) text += character;
      std::string joined;
      for (const std::string& part : runtime::SplitScenario(text)) {
        EXPECT_TRUE(IsUtf8(part)) << character << before;
        EXPECT_LE(part.size(), runtime::kPartBytes);
        joined += part;
      }
      EXPECT_EQ(joined, text);
    }
  }
}

TEST(ScenarioPartsTest, NoticesATextThatWasChangedOnItsWay) {
  const std::string text = LongText();
  std::vector<std::string> parts = runtime::SplitScenario(text);
  parts[2][5] = 'x';
  runtime::ScenarioParts inbox;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_TRUE(
        inbox.Add(runtime::MakeRunPart(1, run_t::PREPARE, 0, runtime::HashOf(text), parts, i)));
  }
  ASSERT_TRUE(inbox.Complete());
  EXPECT_FALSE(inbox.HashHolds());
}

TEST(ScenarioPartsTest, RefusesPartsThatContradictTheFirst) {
  const std::vector<std::string> parts = runtime::SplitScenario(LongText());
  runtime::ScenarioParts inbox;
  EXPECT_TRUE(inbox.Add(runtime::MakeRunPart(1, run_t::PREPARE, 0, "hash", parts, 0)));
  run_t other = runtime::MakeRunPart(1, run_t::PREPARE, 0, "hash", parts, 1);
  other.num_parts = 999;
  EXPECT_FALSE(inbox.Add(other));
  other = runtime::MakeRunPart(1, run_t::PREPARE, 0, "another hash", parts, 1);
  EXPECT_FALSE(inbox.Add(other));
  other = runtime::MakeRunPart(1, run_t::PREPARE, 0, "hash", parts, 1);
  other.header.step = other.num_parts;
  EXPECT_FALSE(inbox.Add(other));
  other.header.step = -1;
  EXPECT_FALSE(inbox.Add(other));
  other = runtime::MakeRunPart(1, run_t::PREPARE, 0, "hash", parts, 0);
  other.text[0] = '#';
  EXPECT_FALSE(inbox.Add(other));
  EXPECT_EQ(inbox.FirstMissing(), 1);
}

TEST(ScenarioPartsTest, EveryPartFitsIntoOneDatagram) {
  const std::string text = LongText();
  const std::vector<std::string> parts = runtime::SplitScenario(text);
  std::vector<std::uint8_t> buffer;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    runtime::Encode(runtime::MakeRunPart(1, run_t::PREPARE, 0, runtime::HashOf(text), parts, i),
                    buffer);
    EXPECT_LE(buffer.size(), runtime::kMaxMessageBytes);
  }
}

}  // namespace
}  // namespace fogline
