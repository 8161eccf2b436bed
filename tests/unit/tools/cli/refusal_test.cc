#include "tools/cli/refusal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/cli/help.h"

namespace fogline::cli {
namespace {

using testing::ElementsAre;
using Words = std::vector<std::string>;

/// A program with two verbs, and the program's error text for a command line.
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
    CLI::App* experiment = app_.add_subcommand("experiment");
    experiment->require_subcommand(1);
    experiment->add_subcommand("export")->add_option("--out", out_)->required();
  }

  /// @param words of the command line, in order. @return the error text; "" if the words are valid
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
  std::string out_;
  double pace_ = 0;
};

TEST_F(RefusalTest, IsNoneForAGoodCommandLine) {
  EXPECT_EQ(Of({"run", "paper.json"}), "");
  EXPECT_EQ(CommandName(app_), "fogline run");
}

TEST_F(RefusalTest, NamesTheProgramWithoutAVerb) { EXPECT_EQ(CommandName(app_), "fogline"); }

TEST_F(RefusalTest, NamesTheActionOfAVerb) {
  EXPECT_EQ(Of({"experiment", "export", "--uot", "x"}),
            "fogline experiment export: error: no option \"--uot\"; did you mean \"--out\"? (see "
            "fogline experiment export --help)");
  EXPECT_EQ(CommandName(app_), "fogline experiment export");
  EXPECT_EQ(Of({"experiment", "exprot"}),
            "fogline experiment: error: no action \"exprot\"; did you mean \"export\"? (see "
            "fogline experiment --help)");
  EXPECT_EQ(Of({"experiment", "plan.json"}),
            "fogline experiment: error: no action \"plan.json\"; the actions are \"export\" (see "
            "fogline experiment --help)");
  RefuseIgnoredValues(app_);
  EXPECT_EQ(Of({"experiment", "export", "--out", ""}),
            "fogline experiment export: error: --out: the text is empty (see fogline experiment "
            "export --help)");
}

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

TEST_F(RefusalTest, NamesTheFirstWrongWordAndNotTheArgumentThatItWouldHaveGiven) {
  const std::string after =
      "fogline experiment: error: no option \"--out\"; an option stands after its action (see "
      "fogline experiment --help)";
  EXPECT_EQ(Of({"experiment", "--out", "x", "export"}), after);
  EXPECT_EQ(Of({"experiment", "--out", "x", "export", "--uot", "x"}), after);
  EXPECT_EQ(Of({"--foo", "experiment", "export"}),
            "fogline: error: no option \"--foo\" (see fogline --help)");
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

TEST_F(RefusalTest, NamesTheWordThatWasTakenForAnOptionRatherThanTheArgumentThatIsMissing) {
  EXPECT_EQ(Of({"run", "-dash.json"}),
            "fogline run: error: no option \"-dash.json\"; a file of this name is "
            "\"./-dash.json\" (see fogline run --help)");
  EXPECT_EQ(Of({"run", "--pase", "3"}),
            "fogline run: error: no option \"--pase\"; did you mean \"--pace\"? (see fogline run "
            "--help)");
  EXPECT_EQ(Of({"run", "--", "-dash.json"}), "");
}

TEST_F(RefusalTest, SaysInPlainWordsWhatAnOptionNeeds) {
  EXPECT_EQ(Of({"run", "paper.json", "--pace", "x"}),
            "fogline run: error: --pace: \"x\" is no number (see fogline run --help)");
  EXPECT_EQ(Of({"run", "paper.json", "--pace"}),
            "fogline run: error: --pace: the value is missing (see fogline run --help)");
}

TEST_F(RefusalTest, IsOneLineWhateverAWordContains) {
  const std::string refusal = Of({"run", "paper.json", "--pace", "a\nb\x1b"});
  EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
  EXPECT_EQ(refusal.find('\x1b'), std::string::npos) << refusal;
}

/// A program with a verb that has options of all types.
class IgnoredValuesTest : public testing::Test {
 protected:
  IgnoredValuesTest() {
    CLI::App* run = app_.add_subcommand("run");
    run->add_option("SCENARIO", scenario_);
    run->add_option("--log", log_);
    run->add_option("-o,--output", output_);
    run->add_option("--set", set_)->allow_extra_args(false);
    run->add_option("--explain", explain_);
    run->add_option("--pace", pace_)->check(NumberIn(0, 10));
    run->add_option("--jobs", jobs_);
    run->add_flag("--force", force_);
    RefuseIgnoredValues(app_);
  }

  /// @return the error text; "" if the words are valid
  std::string Of(const Words& words) {
    Words separate = SeparateEmptyValues(words);
    try {
      app_.parse(Words(separate.rbegin(), separate.rend()));
    } catch (const CLI::ParseError& error) {
      return Refusal(app_, error);
    }
    return "";
  }
  /// Expects that an empty text for this option is refused, in every notation of the option.
  void ExpectRefusal(const std::string& name) {
    const std::string error =
        "fogline run: error: " + name + ": the text is empty (see fogline run --help)";
    EXPECT_EQ(Of({"run", "paper.json", name, ""}), error);
    EXPECT_EQ(Of({"run", name + "=", "paper.json"}), error);
  }

  CLI::App app_{"A program", "fogline"};
  std::filesystem::path scenario_;
  std::filesystem::path log_;
  std::string output_;
  std::vector<std::string> set_;
  std::optional<std::string> explain_;
  double pace_ = 0;
  int jobs_ = 0;
  bool force_ = false;
};

TEST_F(IgnoredValuesTest, WholeNumbersAreDecimal) {
  for (const auto& [text, jobs] :
       {std::pair("010", 10), {"08", 8}, {"0", 0}, {"-07", -7}, {"+5", 5}}) {
    EXPECT_EQ(Of({"run", "paper.json", "--jobs", text}), "");
    EXPECT_EQ(jobs_, jobs) << text;
  }
  for (const std::string text : {"0x10", "1e3", "2.5", "two"}) {
    EXPECT_EQ(Of({"run", "paper.json", "--jobs", text}), "fogline run: error: --jobs: \"" + text +
                                                             "\" is no decimal whole number (see "
                                                             "fogline run --help)");
  }
}

TEST_F(IgnoredValuesTest, EmptyTextsAreRefusedWithTheNameOfTheirOption) {
  for (const char* name : {"--log", "--output", "--set", "--explain", "--pace"}) {
    ExpectRefusal(name);
  }
  EXPECT_EQ(Of({"run", "-o", ""}),
            "fogline run: error: --output: the text is empty (see fogline run --help)");
}

TEST_F(IgnoredValuesTest, EmptyTextsAreRefusedWithTheNameOfTheirArgument) {
  EXPECT_EQ(Of({"run", ""}),
            "fogline run: error: SCENARIO: the text is empty (see fogline run --help)");
}

TEST_F(IgnoredValuesTest, OtherTextsAreTaken) {
  EXPECT_EQ(Of({"run", "paper.json", "--log", "a.lcm", "-o", "b", "--set", "/a=", "--set=/b=1",
                "--explain=/", "--pace", "2", "--force"}),
            "");
  EXPECT_EQ(log_, "a.lcm");
  EXPECT_THAT(set_, ElementsAre("/a=", "/b=1"));
  EXPECT_EQ(explain_, "/");
  EXPECT_TRUE(force_);
}

TEST_F(IgnoredValuesTest, AreRefusedForAFlag) {
  for (const char* word : {"--force=no", "--force=3"}) {
    EXPECT_EQ(Of({"run", "paper.json", word}),
              "fogline run: error: --force takes no value (see fogline run --help)");
    EXPECT_FALSE(force_);
  }
}

TEST(SeparateEmptyValuesTest, LeavesWordsBehindTheEndOfOptionsAsTheyAre) {
  EXPECT_THAT(SeparateEmptyValues({"run", "--log=", "--out=a=", "-=", "--", "--log="}),
              ElementsAre("run", "--log", "", "--out=a=", "-=", "--", "--log="));
}

}  // namespace
}  // namespace fogline::cli
