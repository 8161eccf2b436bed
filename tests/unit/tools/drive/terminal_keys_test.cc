#include "tools/drive/terminal_keys.h"

#include <string>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

using drive::TerminalKey;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<TerminalKey> Keys(const std::vector<std::string>& pieces) {
  drive::KeyParser parser;
  std::vector<TerminalKey> keys;
  for (const std::string& piece : pieces) {
    parser.Parse(piece, [&](TerminalKey key) { keys.push_back(key); });
  }
  return keys;
}

TEST(KeyParserTest, FindsTheArrowsInBothOfTheirSequences) {
  EXPECT_THAT(Keys({"\x1b[A\x1b[B\x1bOA\x1bOB"}),
              ElementsAre(TerminalKey::kThrottle, TerminalKey::kBrake, TerminalKey::kThrottle,
                          TerminalKey::kBrake));
}

TEST(KeyParserTest, FindsASequenceThatComesInPieces) {
  EXPECT_THAT(Keys({"\x1b", "[", "B"}), ElementsAre(TerminalKey::kBrake));
}

TEST(KeyParserTest, FindsTheButtons) {
  EXPECT_THAT(Keys({" tTgG"}),
              ElementsAre(TerminalKey::kTakeOver, TerminalKey::kTakeOver, TerminalKey::kTakeOver,
                          TerminalKey::kGiveBack, TerminalKey::kGiveBack));
}

// The key Delete sends ESC [ 3 ~, Ctrl-left sends ESC [ 1 ; 5 D, and the left arrow sends ESC [ D.
TEST(KeyParserTest, IgnoresOtherKeys) {
  EXPECT_THAT(Keys({"AB\x1b[3~\x1b[1;5D\x1b[Dxyz\n"}), IsEmpty());
  EXPECT_THAT(Keys({"\x1b[3~g"}), ElementsAre(TerminalKey::kGiveBack));
}

}  // namespace
}  // namespace fogline
