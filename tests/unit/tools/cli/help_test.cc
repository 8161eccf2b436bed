#include "tools/cli/help.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>

#include <fmt/core.h>

namespace fogline::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(NumberInTest, TakesNumbersOfItsRangeAndNothingElse) {
  const CLI::Validator number = NumberIn(0, 10);
  const auto complaint = [&number](std::string text) { return number(text); };
  for (const char* good : {"0", "10", "2.5", "1e-3"}) EXPECT_EQ(complaint(good), "") << good;
  for (const char* bad : {"-1", "10.1", "ten", "nan", "inf"}) {
    EXPECT_THAT(complaint(bad), HasSubstr(bad)) << bad;
  }
  for (const char* bad : {"nan", "-1"}) {
    EXPECT_EQ(complaint(bad), fmt::format("Value {} not in range 0 to 10", bad));
  }
}

TEST(NumberInTest, ShowsItsLimitsLikeARangeOfWholeNumbers) {
  std::string text = "-1";
  const CLI::Validator number = NumberIn(0, 1e6);
  EXPECT_EQ(number(text), CLI::Range(0, 1'000'000)(text));
  EXPECT_EQ(number.get_description(), "FLOAT in [0 - 1000000]");
  EXPECT_EQ(NumberIn(0.1, 3600)(text), "Value -1 not in range 0.1 to 3600");
}

/// The help of a program with a verb that has an option with a long description.
class HelpTest : public testing::Test {
 protected:
  HelpTest() {
    app_.formatter(std::make_shared<HelpFormatter>());
    verb_ = app_.add_subcommand("run", "Runs");
    std::string words;
    for (int i = 0; i < 60; ++i) words += "word" + std::to_string(i) + " ";
    verb_->add_option("--option", value_, words);
  }

  CLI::App app_{"A program", "fogline"};
  CLI::App* verb_ = nullptr;
  int value_ = 0;
};

TEST_F(HelpTest, FitsATerminalAndLosesNoWord) {
  const std::string text = HelpText(app_, *verb_);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), kHelpColumns) << line;
  std::istringstream words(text);
  int found = 0;
  for (std::string word; words >> word;) found += word == "word" + std::to_string(found) ? 1 : 0;
  EXPECT_EQ(found, 60);
}

TEST_F(HelpTest, IsThatOfTheProgramOrOfAVerb) {
  EXPECT_THAT(HelpText(app_, app_), HasSubstr("Usage: fogline ["));
  EXPECT_THAT(HelpText(app_, app_), Not(HasSubstr("--option")));
  EXPECT_THAT(HelpText(app_, *verb_), HasSubstr("Usage: fogline run ["));
  EXPECT_THAT(HelpText(app_, *verb_), HasSubstr("--option"));
}

TEST_F(HelpTest, TellsTheExitCodesBeforeItsFooter) {
  ShowExitCodes(*verb_);
  EXPECT_THAT(HelpText(app_, *verb_),
              HasSubstr("Exit codes: 0 done, 2 bad input, 3 failure at run time.\n"));
  ShowExitCodes(*verb_, {.done = "no problem", .check_failed = "a problem", .interruptible = true});
  verb_->footer("Examples: none");
  EXPECT_THAT(HelpText(app_, *verb_),
              HasSubstr("Exit codes: 0 no problem, 1 a problem, 2 bad input, 3 failure at run "
                        "time, 130 interrupted.\n\nExamples: none"));
}

}  // namespace
}  // namespace fogline::cli
