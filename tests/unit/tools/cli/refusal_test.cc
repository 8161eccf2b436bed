#include "tools/cli/refusal.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace fogline::cli {
namespace {

/// A program with two verbs, and its text about a command line.
class RefusalTest : public testing::Test {
 protected:
  RefusalTest() {
    app_.require_subcommand(0, 1);
    CLI::App* run = app_.add_subcommand("run");
    run->add_option("SCENARIO", scenario_)->required();
    run->add_option("--set", set_);
    run->add_option("--pace", pace_);
    CLI::App* table = app_.add_subcommand("table");
    table->add_option("--seeds", seeds_);
  }

  /// @param words in order; "" if they are no error
  std::string Of(const std::vector<std::string>& words) {
    try {
      app_.parse(std::vector(words.rbegin(), words.rend()));
    } catch (const CLI::Success&) {
      return UnknownVerb(app_);
    } catch (const CLI::ParseError& error) {
      return Refusal(app_, error);
    }
    return "";
  }

  CLI::App app_{"A program", "fogline"};
  std::string scenario_;
  std::string set_;
  std::string seeds_;
  double pace_ = 0;
};

TEST_F(RefusalTest, IsNoneForAGoodCommandLine) {
  EXPECT_EQ(Of({"run", "paper.json"}), "");
  EXPECT_EQ(CommandName(app_), "fogline run");
}

TEST_F(RefusalTest, NamesTheProgramWithoutAVerb) { EXPECT_EQ(CommandName(app_), "fogline"); }

TEST_F(RefusalTest, SuggestsTheVerbThatWasMeant) {
  EXPECT_EQ(Of({"tabel"}),
            "fogline: error: no verb \"tabel\"; did you mean \"table\"? (see fogline --help)");
  EXPECT_EQ(NoSuchVerb(app_, "levitate"), "no verb \"levitate\"");
}

TEST_F(RefusalTest, IsAlsoForAnUnknownVerbWhoseHelpIsAskedFor) {
  EXPECT_EQ(Of({"levitate", "--help"}),
            "fogline: error: no verb \"levitate\" (see fogline --help)");
  EXPECT_EQ(Of({"run", "--help"}), "");
}

TEST_F(RefusalTest, TellsWhichOptionWasMeant) {
  EXPECT_EQ(Of({"run", "paper.json", "--pase", "3"}),
            "fogline run: error: no option \"--pase\"; did you mean \"--pace\"? (see fogline run "
            "--help)");
}

TEST_F(RefusalTest, TellsWhichVerbHasAnOption) {
  EXPECT_EQ(Of({"run", "paper.json", "--seeds", "3"}),
            "fogline run: error: no option \"--seeds\"; it is an option of fogline table (see "
            "fogline run --help)");
  EXPECT_EQ(Of({"--seeds", "3"}),
            "fogline: error: no option \"--seeds\"; an option stands after its verb (see fogline "
            "--help)");
}

TEST_F(RefusalTest, TellsHowAFieldOfTheScenarioIsSet) {
  EXPECT_EQ(Of({"run", "paper.json", "--threshold=0.8"}),
            "fogline run: error: no option \"--threshold\"; a field of the scenario is set with "
            "--set /arbitrator/threshold=0.8 (see fogline run --help)");
}

TEST_F(RefusalTest, TellsOfAnArgumentThatIsMissingOrTooMuch) {
  EXPECT_EQ(Of({"run"}), "fogline run: error: SCENARIO is required (see fogline run --help)");
  EXPECT_EQ(Of({"run", "one.json", "two.json"}),
            "fogline run: error: \"two.json\" is one argument too many (see fogline run --help)");
}

TEST_F(RefusalTest, IsOneLineWhateverAWordContains) {
  const std::string refusal = Of({"run", "paper.json", "--pace", "a\nb\x1b"});
  EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
  EXPECT_EQ(refusal.find('\x1b'), std::string::npos) << refusal;
}

}  // namespace
}  // namespace fogline::cli
