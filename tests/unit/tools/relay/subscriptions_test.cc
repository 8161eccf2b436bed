#include "tools/relay/subscriptions.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <vector>

namespace fogline {
namespace {

constexpr std::size_t kLimit = 10;

/// Matches at a fixed time. So the budget of processor time does not fill again.
bool Match(relay::Subscriptions& subscriptions, std::string_view channel) {
  return subscriptions.Match(channel, TimePoint{});
}

TEST(SubscriptionsTest, MatchWholeChannelNamesOnly) {
  relay::Subscriptions wanted(kLimit);
  EXPECT_FALSE(Match(wanted, "TRUTH"));
  EXPECT_EQ(wanted.Add("TRUTH"), "");
  EXPECT_TRUE(Match(wanted, "TRUTH"));
  EXPECT_FALSE(Match(wanted, "TRUTH2"));
  EXPECT_FALSE(Match(wanted, "A_TRUTH"));
}

TEST(SubscriptionsTest, AreRegularExpressionsAsLcms) {
  relay::Subscriptions wanted(kLimit);
  for (const char* pattern : {"HOST_.*", "^(RADAR|LIDAR)$", R"(A\.B)", "CAM[0-9]"}) {
    EXPECT_EQ(wanted.Add(pattern), "") << pattern;
  }
  for (const char* channel : {"HOST_EGO", "RADAR", "LIDAR", "A.B", "CAM7"}) {
    EXPECT_TRUE(Match(wanted, channel)) << channel;
  }
  for (const char* channel : {"HOST", "AxB", "CAM10", "radar"}) {
    EXPECT_FALSE(Match(wanted, channel)) << channel;
  }
}

TEST(SubscriptionsTest, EndOneByOne) {
  relay::Subscriptions wanted(kLimit);
  wanted.Add("A");
  wanted.Add("A");
  wanted.Remove("A");
  EXPECT_TRUE(Match(wanted, "A"));
  wanted.Remove("A");
  EXPECT_FALSE(Match(wanted, "A"));
  wanted.Remove("A");  // the pattern is already removed; LCM ignores this, too
}

TEST(SubscriptionsTest, ForgetAnswersWhenTheyChange) {
  relay::Subscriptions wanted(kLimit);
  EXPECT_FALSE(Match(wanted, "A"));
  wanted.Add("A");
  EXPECT_TRUE(Match(wanted, "A"));
}

TEST(SubscriptionsTest, AreLimitedInNumber) {
  relay::Subscriptions wanted(2);
  EXPECT_EQ(wanted.Add("A"), "");
  EXPECT_EQ(wanted.Add("B"), "");
  EXPECT_EQ(wanted.Add("C"), "more than 2 subscriptions");
  EXPECT_FALSE(Match(wanted, "C"));
}

TEST(SubscriptionsTest, AreLimitedInLengthTogether) {
  // A compiled expression takes up to a few hundred times its length in memory. So the relay limits
  // the length of all expressions together.
  relay::Subscriptions wanted(1000);
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
  relay::Subscriptions wanted(kLimit);
  for (const char* pattern : {"(", "[a", "*"}) {
    EXPECT_EQ(wanted.Add(pattern), "a subscription that is no regular expression") << pattern;
    EXPECT_FALSE(Match(wanted, "a"));
  }
}

TEST(SubscriptionsTest, SurviveExpressionsMadeAtRandom) {
  // The pieces are mostly characters that the parser of expressions treats specially. Sanitizers
  // check the memory accesses of this test.
  constexpr std::string_view kPieces = "AB.*+?|()[]{}^$-,:=!<\\1dQEx";
  std::mt19937_64 engine(20'260'101);
  int refused = 0;
  constexpr int kPatterns = 5000;
  for (int i = 0; i < kPatterns; ++i) {
    std::string pattern;
    for (auto n = engine() % 24; n > 0; --n) pattern += kPieces[engine() % kPieces.size()];
    relay::Subscriptions wanted(1);
    // The pattern has a block of memory of its own, so a sanitizer finds a read beyond its end.
    const std::vector<char> exact(pattern.begin(), pattern.end());
    if (!wanted.Add({exact.data(), exact.size()}).empty()) {
      ++refused;
      continue;
    }
    try {
      Match(wanted, "AB");
    } catch (const std::runtime_error&) {
    }
  }
  // The test proves nothing if all patterns are refused, or none.
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, kPatterns);
}

TEST(SubscriptionsTest, GiveUpExpressionsThatTakeExponentialTime) {
  // GIVEN an expression that backtracks over every possible division of the longest name
  relay::Subscriptions wanted(kLimit);
  ASSERT_EQ(wanted.Add("(a|aa|a?)*(a|aa|a?)*(a|aa|a?)*b"), "");
  const std::string longest(63, 'a');
  // WHEN this name is matched
  const auto began = std::chrono::steady_clock::now();
  try {
    EXPECT_FALSE(Match(wanted, longest));
  } catch (const std::runtime_error&) {
  }
  // THEN the search ends, within the time that a busy machine needs for a million tries
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(2));
}

TEST(SubscriptionsTest, GiveUpManySlowExpressionsAsOne) {
  // GIVEN slow expressions. Boost limits the number of steps of a search. This limit ends none of
  // these searches, because it is higher for long expressions
  relay::Subscriptions wanted(1000);
  for (int i = 0; i < 100; ++i) wanted.Add("(a|aa)+b" + std::string(240, 'c'));
  // WHEN a name is matched with all of them, THEN the search ends before the last expression
  EXPECT_THROW(Match(wanted, std::string(24, 'a')), std::runtime_error);
}

/// This expression is so slow that a few dozen names of SlowName() take a tenth of a second. Boost
/// limits the number of steps of a search. This limit does not end the search, because it is higher
/// for a long expression.
const std::string kSlow = "(a|aa)+b" + std::string(240, 'c');
std::string SlowName(int i) { return std::string(20, 'a') + std::to_string(i); }

/// The number of new names that are matched before the budget of processor time is spent. It is a
/// thousand at most.
int NamesUntilTheEnd(relay::Subscriptions& wanted, int first, TimePoint now) {
  for (int i = 0; i < 1000; ++i) {
    try {
      wanted.Match(SlowName(first + i), now);
    } catch (const std::runtime_error&) {
      return i;
    }
  }
  return 1000;
}

TEST(SubscriptionsTest, SpendABudgetOnNewNamesThatFillsAgain) {
  relay::Subscriptions wanted(kLimit);
  ASSERT_EQ(wanted.Add(kSlow), "");
  // GIVEN more and more new names. Boost's limit on the steps of a search ends no single search
  const int stood = NamesUntilTheEnd(wanted, 0, TimePoint{});
  EXPECT_GT(stood, 1);
  EXPECT_LT(stood, 1000) << "all of them together are";
  // WHEN time has passed, THEN a few more names are possible, but fewer than at first
  const int more = NamesUntilTheEnd(wanted, 1000, TimePoint{} + std::chrono::seconds(2));
  EXPECT_GT(more, 0);
  EXPECT_LT(more, stood);
  EXPECT_EQ(NamesUntilTheEnd(wanted, 2000, TimePoint{} + std::chrono::seconds(2)), 0);
}

TEST(SubscriptionsTest, StandAFloodOfNamesIfTheyAreSimple) {
  relay::Subscriptions wanted(kLimit);
  for (const char* pattern : {"TRUTH", "HOST_.*", "RADAR|LIDAR"})
    ASSERT_EQ(wanted.Add(pattern), "");
  for (int i = 0; i < 20'000; ++i) {
    EXPECT_FALSE(Match(wanted, "NAME_" + std::to_string(i)));
  }
}

}  // namespace
}  // namespace fogline
