#include "tools/cli/completion/completion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "services/graph.h"

namespace fogline::cli {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// A program with the kinds of options that verbs have.
class CompletionTest : public testing::Test {
 protected:
  CompletionTest() {
    app_.add_flag("--version")->description("Print the version");
    CLI::App* run = app_.add_subcommand("run", "Run a scenario");
    run->add_option("SCENARIO", text_);
    run->add_option("--set", texts_, "Override a field")->allow_extra_args(false);
    run->add_option("--grid", texts_)->allow_extra_args(false);
    run->add_option("--seed", number_, "Seed");
    run->add_option("--side", text_)->check(CLI::IsMember({"left", "right"}));
    run->add_option("--log", text_, "Event log to write");
    run->add_option("--secret", text_)->group("");
    run->add_flag("--json", flag_);
    CLI::App* merge = app_.add_subcommand("metrics", "Measure runs");
    merge->add_option("LOG", texts_);
    merge->add_option("--merge", texts_);
    merge->add_option("--role", text_);
    merge->add_option("--on", texts_)->allow_extra_args(false);
    merge->add_option("--lab", text_);
    CLI::App* help = app_.add_subcommand("help", "Explain");
    help->add_option("VERB", text_);
    app_.add_subcommand("experiment", "Make trials")->add_subcommand("status", "Show trials");
    app_.add_subcommand("study", "Answer")->add_option("NAME", text_, "One of delay, policy, all");
  }

  Completion At(const std::vector<std::string>& words) const { return Complete(app_, words); }
  std::vector<std::string> Words(const std::vector<std::string>& words) const {
    std::vector<std::string> found;
    for (const Suggestion& suggestion : At(words).words) found.push_back(suggestion.word);
    return found;
  }

 private:
  CLI::App app_{"A program", "fogline"};
  std::string text_;
  std::vector<std::string> texts_;
  int number_ = 0;
  bool flag_ = false;
};

TEST_F(CompletionTest, OfTheFirstWordIsTheVerbsWithTheirMeanings) {
  EXPECT_THAT(Words({""}), ElementsAre("run", "metrics", "help", "experiment", "study"));
  ASSERT_THAT(At({"r"}).words, SizeIs(1));
  EXPECT_EQ(At({"r"}).words.front().meaning, "Run a scenario");
  EXPECT_THAT(Words({"--v"}), ElementsAre("--version"));
  EXPECT_THAT(Words({}), IsEmpty());
}

TEST_F(CompletionTest, OfAVerbInAVerbIsThatVerb) {
  EXPECT_THAT(Words({"experiment", ""}), ElementsAre("status"));
  EXPECT_THAT(Words({"help", "m"}), ElementsAre("metrics"));
}

TEST_F(CompletionTest, OfADashIsTheOptionsOfTheVerbThatAreShown) {
  EXPECT_THAT(Words({"run", "-"}),
              ElementsAre("--help", "--set", "--grid", "--seed", "--side", "--log", "--json"));
  EXPECT_THAT(Words({"run", "paper.json", "--se"}), ElementsAre("--set", "--seed"));
  EXPECT_THAT(Words({"run", "--log", "--se"}), IsEmpty()) << "--log takes the word";
  EXPECT_THAT(Words({"run", "--", "--se"}), IsEmpty());
}

TEST_F(CompletionTest, OfAFieldIsTheNextSegmentOfItsPointer) {
  EXPECT_THAT(Words({"run", "paper.json", "--set", "/arb"}), ElementsAre("/arbitrator/"));
  EXPECT_THAT(Words({"run", "--set", "/arbitrator/thr"}), Contains("/arbitrator/threshold="));
  EXPECT_THAT(Words({"run", "--set", ""}), Contains("/fog/"));
  EXPECT_THAT(Words({"run", "--set", ""}), Contains("/seed="));
  EXPECT_THAT(Words({"run", "--set=/arb"}), ElementsAre("--set=/arbitrator/"));
  EXPECT_THAT(Words({"run", "--set", "/nowhere"}), IsEmpty());
}

TEST_F(CompletionTest, OfTheValueOfAFieldIsOneOfItsNames) {
  EXPECT_THAT(Words({"run", "--set", "/arbitrator/policy=no"}),
              Contains("/arbitrator/policy=none"));
  EXPECT_THAT(Words({"run", "--grid", "/arbitrator/policy=none,no"}),
              Contains("/arbitrator/policy=none,none"));
  EXPECT_THAT(Words({"run", "--set", "/world/end_on_collision="}),
              ElementsAre("/world/end_on_collision=true", "/world/end_on_collision=false"));
  EXPECT_THAT(Words({"run", "--set", "/arbitrator/threshold="}), IsEmpty());
  EXPECT_EQ(At({"run", "--set", "/arbitrator/threshold="}).files, "");
}

TEST_F(CompletionTest, OfAnOptionWithNamesIsItsNames) {
  EXPECT_THAT(Words({"run", "--side", ""}), testing::UnorderedElementsAre("left", "right"));
  EXPECT_THAT(Words({"run", "--side=r"}), ElementsAre("--side=right"));
  EXPECT_THAT(Words({"metrics", "--role", ""}), SizeIs(kRoles.size()));
  EXPECT_THAT(Words({"study", ""}), ElementsAre("delay", "policy", "all"));
}

TEST_F(CompletionTest, OfAPlaceIsARoleThatMayRunElsewhere) {
  EXPECT_THAT(Words({"metrics", "--on", "fu"}), ElementsAre("fusion="));
  EXPECT_THAT(Words({"metrics", "--on", "fusion=lab2", "--on", ""}), SizeIs(kRoles.size() - 1));
  EXPECT_THAT(Words({"metrics", "--on", "rec"}), IsEmpty());
}

TEST_F(CompletionTest, OfATextIsAFileAndOfANumberNothing) {
  EXPECT_EQ(At({"run", ""}).files, "*.json");
  EXPECT_EQ(At({"run", "--log", ""}).files, "*");
  EXPECT_EQ(At({"metrics", "--lab", ""}).files, "*.json");
  EXPECT_EQ(At({"run", "--seed", ""}).files, "");
  EXPECT_EQ(At({"run", "--json", ""}).files, "*.json") << "a flag takes no word";
  EXPECT_EQ(At({"run", "a.json", ""}).files, "") << "SCENARIO is one file";
  EXPECT_EQ(At({"metrics", "a.lcm", "b.lcm", ""}).files, "*.lcm");
  EXPECT_EQ(At({"metrics", "--merge", "a.csv", ""}).files, "*");
  EXPECT_THAT(Words({"metrics", "--merge", "a.csv", "--ro"}), ElementsAre("--role"));
}

TEST_F(CompletionTest, IsPrintedAsWordsWithMeaningsAndFiles) {
  EXPECT_EQ(ToText({.words = {{"run", "Run a scenario"}}, .files = "*.json"}),
            "run\tRun a scenario\n@files\t*.json\n");
}

}  // namespace
}  // namespace fogline::cli
