#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "tests/property/scenario/random_scenario.h"

namespace fogline {
namespace {

std::string RandomWord(ValueDraw& draw) {
  std::string word;
  for (std::size_t n = draw.Below(9); n > 0; --n) word += static_cast<char>('a' + draw.Below(3));
  return word;
}

// Returns `word` after one random insertion, deletion, substitution, or swap of neighbouring
// letters. @pre `word` is not empty
std::string WithOneEdit(std::string word, ValueDraw& draw) {
  const std::size_t at = draw.Below(word.size());
  const char letter = static_cast<char>('a' + draw.Below(26));
  switch (draw.Below(4)) {
    case 0:
      return word.insert(at, 1, letter);
    case 1:
      return word.erase(at, 1);
    case 2:
      word[at] = letter;
      return word;
    default:
      if (at + 1 < word.size()) std::swap(word[at], word[at + 1]);
      return word;
  }
}

TEST(EditDistanceProperty, IsSymmetricZeroForEqualWordsOnlyAndAtMostTheLongerLength) {
  ValueDraw draw(1);
  for (int i = 0; i < 5000; ++i) {
    const std::string a = RandomWord(draw);
    const std::string b = RandomWord(draw);
    const std::size_t distance = EditDistance(a, b);
    EXPECT_EQ(distance, EditDistance(b, a)) << a << ' ' << b;
    EXPECT_EQ(distance == 0, a == b) << a << ' ' << b;
    EXPECT_LE(distance, std::max(a.size(), b.size())) << a << ' ' << b;
    EXPECT_GE(distance, std::max(a.size(), b.size()) - std::min(a.size(), b.size()));
  }
}

TEST(EditDistanceProperty, IsAtMostOneAfterOneEdit) {
  ValueDraw draw(2);
  for (int i = 0; i < 5000; ++i) {
    std::string word = RandomWord(draw);
    word.push_back('a');
    const std::string edited = WithOneEdit(word, draw);
    EXPECT_LE(EditDistance(word, edited), 1U) << word << ' ' << edited;
  }
}

TEST(SuggestionProperty, APointerWithOneLetterTooMuchGetsANeighbourInOneEdit) {
  ValueDraw draw(3);
  for (const Field& field : Catalogue()) {
    std::string wrong = field.pointer;
    wrong.insert(2 + draw.Below(wrong.size() - 2), 1, 'z');
    const auto suggestion = SuggestPointer(wrong);
    ASSERT_TRUE(suggestion) << wrong;
    EXPECT_EQ(EditDistance(wrong, *suggestion), 1U) << wrong << ' ' << *suggestion;
  }
}

}  // namespace
}  // namespace fogline
