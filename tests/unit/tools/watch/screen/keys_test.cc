#include "tools/watch/screen/keys.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <vector>

namespace fogline::watch {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<Key> Keys(KeyReader& reader, std::string_view bytes, bool complete = false) {
  reader.Take(bytes);
  std::vector<Key> keys;
  while (const auto key = reader.Next(complete)) keys.push_back(*key);
  return keys;
}

TEST(KeyReaderTest, KnowsTheCursorKeysInBothFormsOfTerminals) {
  KeyReader reader;
  EXPECT_THAT(Keys(reader, "\033[A\033OB\033[C\033OD\033[5~\033[6~\033[H\033[4~"),
              ElementsAre(Key::kUp, Key::kDown, Key::kOpen, Key::kClose, Key::kPageUp,
                          Key::kPageDown, Key::kHome, Key::kEnd));
}

TEST(KeyReaderTest, WaitsForTheRestOfASequence) {
  KeyReader reader;
  EXPECT_THAT(Keys(reader, "\033"), IsEmpty());
  EXPECT_THAT(Keys(reader, "["), IsEmpty());
  EXPECT_THAT(Keys(reader, "B"), ElementsAre(Key::kDown));
}

TEST(KeyReaderTest, TakesALoneEscapeForTheKeyWhenNothingFollows) {
  KeyReader reader;
  EXPECT_THAT(Keys(reader, "\033"), IsEmpty());
  EXPECT_THAT(Keys(reader, "", true), ElementsAre(Key::kClose));
  EXPECT_THAT(Keys(reader, "\033q"), ElementsAre(Key::kClose, Key::kQuit));
}

TEST(KeyReaderTest, LeavesOutWhatIsNoKeyOfTheProgram) {
  KeyReader reader;
  EXPECT_THAT(Keys(reader, "x\033[1;5Zy\033[200~s"), ElementsAre(Key::kSort));
  EXPECT_THAT(Keys(reader, "\xff\x00\033[99", true), IsEmpty());
  EXPECT_THAT(Keys(reader, "r"), ElementsAre(Key::kReverse));
}

}  // namespace
}  // namespace fogline::watch
