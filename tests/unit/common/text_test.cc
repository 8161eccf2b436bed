#include "common/text.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr std::array<std::string_view, 3> kNames{"threshold", "speed_mps", "speed_s"};

TEST(TextTest, WritesNumbersShortAndExact) {
  EXPECT_EQ(NumberText(20.0), "20");
  EXPECT_EQ(NumberText(0.1), "0.1");
  EXPECT_EQ(NumberText(-0.0), "-0.0");
  EXPECT_EQ(NumberText(1e5), "100000");
  EXPECT_EQ(NumberText(0.1 + 0.2), "0.30000000000000004");
}

TEST(TextTest, QuotesSoThatNothingReachesTheTerminal) {
  EXPECT_EQ(Quote("a\"b\\c"), R"("a\"b\\c")");
  EXPECT_EQ(Quote("\x1b[31m\n\x7f\xc2\x9b"), R"("\u001b[31m\u000a\u007f\u009b")");
  EXPECT_EQ(Quote("\xc3\xa4"), "\"\xc3\xa4\"");
}

TEST(TextTest, EscapesWhatIsNotSeenButChangesWhatIs) {
  // Right-to-left override, zero width space, byte order mark, line separator, tag.
  EXPECT_EQ(EscapeControls("\xe2\x80\xae|\xe2\x80\x8b|\xef\xbb\xbf|\xe2\x80\xa8|\xf3\xa0\x81\x81"),
            R"(\u202e|\u200b|\ufeff|\u2028|\udb40\udc41)");
  // Letters of any script and symbols stay unchanged.
  const std::string seen =
      "\xc3\xa4 \xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d \xe4\xbd\xa0 \xf0\x9f\x8c\xab \xe2\x82\xac";
  EXPECT_EQ(EscapeControls(seen), seen);
}

TEST(TextTest, EscapesWhatIsNoUtf8ByteByByte) {
  // A continuation byte alone, a byte that UTF-8 never has, a surrogate, an overlong form, an
  // incomplete character.
  EXPECT_EQ(EscapeControls("\x9b|\xff|\xed\xa0\x80|\xc0\xaf|\xe2\x82"),
            R"(\x9b|\xff|\xed\xa0\x80|\xc0\xaf|\xe2\x82)");
}

TEST(TextTest, KeepsLineFeedsOfALongerText) {
  EXPECT_EQ(EscapeLines("one\ntwo\x1b\n"), "one\ntwo\\u001b\n");
  EXPECT_EQ(PathText("logs/a\nb.lcm"), "logs/a\\u000ab.lcm");
}

TEST(TextTest, CutsLongTextsBetweenCharacters) {
  std::string umlauts;
  for (int i = 0; i < 200; ++i) umlauts += "\xc3\xa4";
  const std::string shown = Shown("x" + umlauts);
  EXPECT_TRUE(IsUtf8(shown));
  EXPECT_LT(shown.size(), 110U);
  EXPECT_TRUE(shown.ends_with("..."));
}

TEST(TextTest, CountsEachKindOfEditOnce) {
  EXPECT_EQ(EditDistance("threshold", "threshold"), 0U);
  EXPECT_EQ(EditDistance("treshold", "threshold"), 1U);
  EXPECT_EQ(EditDistance("threshhold", "threshold"), 1U);
  EXPECT_EQ(EditDistance("thrashold", "threshold"), 1U);
  EXPECT_EQ(EditDistance("htreshold", "threshold"), 1U);
  EXPECT_EQ(EditDistance("", "fog"), 3U);
  EXPECT_EQ(EditDistance("fog", ""), 3U);
}

TEST(TextTest, PrintsOnlyAsciiOfWhatComesFromStrangers) {
  EXPECT_EQ(Printable("lab2 (a~b)"), "lab2 (a~b)");
  EXPECT_EQ(Printable("\x1b[31m\n\xff\x7f"), "?[31m???");
}

TEST(TextTest, SuggestsTheNearestNameOrNone) {
  EXPECT_EQ(Nearest("treshold", kNames), "threshold");
  EXPECT_EQ(Nearest("speed", kNames), "speed_mps");
  EXPECT_EQ(Nearest("speed_kmh", kNames), "speed_mps");
  EXPECT_EQ(Nearest("weather", kNames), std::nullopt);
  EXPECT_EQ(Nearest(std::string(100'000, 't'), kNames), std::nullopt);
}

TEST(TextTest, CountsCharactersNotBytes) {
  EXPECT_EQ(CountCharacters("A\xc3\xa4\xe2\x82\xac\xf0\x9f\x8c\xab"), 4U);
}

TEST(TextTest, FindsControlCharactersOfAllThreeKinds) {
  EXPECT_TRUE(HasControlCharacter("a\tb"));
  EXPECT_TRUE(HasControlCharacter("a\x7f"));
  EXPECT_TRUE(HasControlCharacter("\xc2\x85"));
  EXPECT_FALSE(HasControlCharacter("\xc2\xa0 \xc3\x85"));
}

}  // namespace
}  // namespace fogline
