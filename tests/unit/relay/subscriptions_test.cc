#include "tools/relay/subscriptions.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <vector>

namespace fogline {
namespace {

constexpr std::size_t kLimit = 10;

TEST(SubscriptionsTest, MatchWholeChannelNamesOnly) {
  Subscriptions wanted(kLimit);
  EXPECT_FALSE(wanted.Match("TRUTH"));
  EXPECT_EQ(wanted.Add("TRUTH"), "");
  EXPECT_TRUE(wanted.Match("TRUTH"));
  EXPECT_FALSE(wanted.Match("TRUTH2"));
  EXPECT_FALSE(wanted.Match("A_TRUTH"));
}

TEST(SubscriptionsTest, AreRegularExpressionsAsLcms) {
  Subscriptions wanted(kLimit);
  for (const char* pattern : {"HOST_.*", "^(RADAR|LIDAR)$", R"(A\.B)", "CAM[0-9]"}) {
    EXPECT_EQ(wanted.Add(pattern), "") << pattern;
  }
  for (const char* channel : {"HOST_EGO", "RADAR", "LIDAR", "A.B", "CAM7"}) {
    EXPECT_TRUE(wanted.Match(channel)) << channel;
  }
  for (const char* channel : {"HOST", "AxB", "CAM10", "radar"}) {
    EXPECT_FALSE(wanted.Match(channel)) << channel;
  }
}

TEST(SubscriptionsTest, EndOneByOne) {
  Subscriptions wanted(kLimit);
  wanted.Add("A");
  wanted.Add("A");
  wanted.Remove("A");
  EXPECT_TRUE(wanted.Match("A"));
  wanted.Remove("A");
  EXPECT_FALSE(wanted.Match("A"));
  wanted.Remove("A");  // never added: ignored, as in LCM
}

TEST(SubscriptionsTest, ForgetAnswersWhenTheyChange) {
  Subscriptions wanted(kLimit);
  EXPECT_FALSE(wanted.Match("A"));
  wanted.Add("A");
  EXPECT_TRUE(wanted.Match("A"));
}

TEST(SubscriptionsTest, AreLimitedInNumber) {
  Subscriptions wanted(2);
  EXPECT_EQ(wanted.Add("A"), "");
  EXPECT_EQ(wanted.Add("B"), "");
  EXPECT_EQ(wanted.Add("C"), "more than 2 subscriptions");
  EXPECT_FALSE(wanted.Match("C"));
}

TEST(SubscriptionsTest, AreLimitedInLengthTogether) {
  // Compiled, an expression takes up to a few hundred times its length in memory.
  Subscriptions wanted(1000);
  const std::string longest(250, 'A');
  int added = 0;
  while (added < 1000 && wanted.Add(longest).empty()) ++added;
  EXPECT_EQ(added, 129);
  EXPECT_EQ(wanted.Add(longest), "more than 32256 bytes of subscriptions");
  EXPECT_EQ(wanted.Add("B"), "") << "there is room for a short one";
  wanted.Remove(longest);
  EXPECT_EQ(wanted.Add(longest), "") << "what is taken away makes room";
}

TEST(SubscriptionsTest, RefuseWhatIsNoRegularExpression) {
  Subscriptions wanted(kLimit);
  for (const char* pattern : {"(", "[a", "*"}) {
    EXPECT_EQ(wanted.Add(pattern), "a subscription that is no regular expression") << pattern;
    EXPECT_FALSE(wanted.Match("a"));
  }
}

TEST(SubscriptionsTest, SurviveExpressionsMadeAtRandom) {
  // Mostly what the parser of expressions has to look at twice; sanitizers watch.
  constexpr std::string_view kPieces = "AB.*+?|()[]{}^$-,:=!<\\1dQEx";
  std::mt19937_64 engine(20'260'101);
  int refused = 0;
  constexpr int kPatterns = 5000;
  for (int i = 0; i < kPatterns; ++i) {
    std::string pattern;
    for (auto n = engine() % 24; n > 0; --n) pattern += kPieces[engine() % kPieces.size()];
    Subscriptions wanted(1);
    // A part of a larger buffer, as it comes from a socket: nothing behind it may be looked at.
    const std::vector<char> exact(pattern.begin(), pattern.end());
    if (!wanted.Add({exact.data(), exact.size()}).empty()) {
      ++refused;
      continue;
    }
    try {
      wanted.Match("AB");
    } catch (const std::runtime_error&) {
    }
  }
  // Patterns that are all refused, or all accepted, would test nothing.
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, kPatterns);
}

TEST(SubscriptionsTest, GiveUpExpressionsThatTakeExponentialTime) {
  // GIVEN an expression that backtracks over every way to cut the longest name into pieces
  Subscriptions wanted(kLimit);
  ASSERT_EQ(wanted.Add("(a|aa|a?)*(a|aa|a?)*(a|aa|a?)*b"), "");
  const std::string longest(63, 'a');
  // WHEN it is asked about that name
  const auto began = std::chrono::steady_clock::now();
  try {
    EXPECT_FALSE(wanted.Match(longest));
  } catch (const std::runtime_error&) {
  }
  // THEN that ends, here within what a busy machine needs for a million tries
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(2));
}

TEST(SubscriptionsTest, GiveUpManySlowExpressionsAsOne) {
  // GIVEN expressions that are slow, each not slow enough to be given up (long ones may visit more)
  Subscriptions wanted(1000);
  for (int i = 0; i < 100; ++i) wanted.Add("(a|aa)+b" + std::string(240, 'c'));
  // WHEN a name is looked for in all of them, THEN that ends before the last
  EXPECT_THROW(wanted.Match(std::string(24, 'a')), std::runtime_error);
}

}  // namespace
}  // namespace fogline
