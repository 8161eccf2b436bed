// The help of tools/soak and of its program, and the refusal of wrong options. tests/soak tests the
// runs.
#include <chrono>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// The outcome of the program soak with these options. If the program accepted a wrong option, it
/// would run for an hour. The time limit ends such a run.
Outcome Soak(std::vector<std::string> options) {
  options.insert(options.begin(), Program("soak"));
  return RunCommand(options);
}

/// The options of a help text. Each option is at the beginning of a line.
std::set<std::string> OptionsIn(const std::string& help) {
  static const std::regex kOption(R"((^|\n) +(-h,)?(--[a-z]+))");
  std::set<std::string> options;
  for (std::sregex_iterator found(help.begin(), help.end(), kOption), end; found != end; ++found) {
    options.insert((*found)[3]);
  }
  return options;
}

TEST(SoakTest, RefusesANumberOutsideItsRangeInOneLine) {
  struct Wrong {
    std::string option;
    std::vector<std::string> values;
    std::string range;
  };
  const std::vector<Wrong> all{
      {"--minutes", {"nan", "inf", "-1", "0", "abc", "1e9"}, "1e-09 to 525600"},
      {"--freeze", {"nan", "-1", "0.05", "61", "abc"}, "0.1 to 60"},
      {"--partition", {"nan", "-1", "0.05", "61", "abc"}, "0.1 to 60"},
      {"--runs", {"nan", "-1", "0", "1.5", "99999999999999999999"}, "1 to 1000000000"},
      {"--each", {"nan", "-1", "0", "1.5", "99999999999999999999"}, "1 to 1000000000"},
      {"--first", {"nan", "-1", "abc", "99999999999999999999"}, "0 to 1000000000"},
      {"--jobs", {"nan", "0", "65"}, "1 to 64"},
      // the range of `fogline run --seed`
      {"--seed",
       {"nan", "-1", "1.5", "9007199254740992", "99999999999999999999999999"},
       "0 to 9007199254740991"}};
  for (const Wrong& wrong : all) {
    for (const std::string& value : wrong.values) {
      const Outcome outcome = Soak({wrong.option + "=" + value});
      EXPECT_EQ(outcome.code, 2) << wrong.option << " " << value;
      EXPECT_EQ(outcome.out, "");
      EXPECT_EQ(outcome.err, "soak: error: " + wrong.option + ": Value " + value +
                                 " not in range " + wrong.range + " (see tools/soak --help)\n");
    }
  }
}

TEST(SoakTest, TakesTheLargestSeedOfAScenario) {
  // The time limit of this call has passed before the first run. So the program checks its options,
  // and makes no run.
  const Outcome outcome = Soak({"--minutes", "1e-9", "--seed", "9007199254740991"});
  EXPECT_NE(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("--seed")));
}

TEST(SoakTest, HelpOfTheScriptNamesTheOptionsAndKindsOfTheProgram) {
  const std::string script = RunCommand({"tools/soak", "--help"}).out;
  EXPECT_EQ(OptionsIn(script), OptionsIn(Soak({"--help"}).out));
  EXPECT_GE(OptionsIn(script).size(), 10U);
  // The refusal of a wrong kind names all kinds: "not in {none,loss,...}".
  const std::string refusal = Soak({"--only", "nothing"}).err;
  const std::size_t begin = refusal.find('{') + 1;
  const std::string kinds = refusal.substr(begin, refusal.find('}') - begin);
  static const std::regex kName("[a-z]+");
  int names = 0;
  for (std::sregex_iterator kind(kinds.begin(), kinds.end(), kName), end; kind != end; ++kind) {
    EXPECT_THAT(script, ContainsRegex("--only KIND [^-]*[ \n]" + kind->str() + "[, \n]"));
    ++names;
  }
  EXPECT_GE(names, 14) << refusal;
}

TEST(SoakTest, TheScriptInstallsAndBuildsNothingForAWrongOption) {
  // GIVEN a shell without the programs that install, build and run
  const ScratchFolder folder;
  for (const char* program : {"bash", "cat", "dirname"}) {
    std::filesystem::create_symlink(std::filesystem::path("/usr/bin") / program,
                                    folder.path() / program);
  }
  const auto refusal = [&folder](const std::vector<std::string>& options) {
    std::vector<std::string> command{"/usr/bin/env", "PATH=" + folder.path().string(),
                                     "tools/soak"};
    command.insert(command.end(), options.begin(), options.end());
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  };
  for (const std::string& option : OptionsIn(RunCommand({"tools/soak", "--help"}).out)) {
    if (option == "--help") continue;
    EXPECT_EQ(refusal({option}),
              "tools/soak: error: " + option + " needs a value; see tools/soak --help\n");
  }
  EXPECT_EQ(refusal({"--minutes", "5", "--fast"}),
            "tools/soak: error: unknown argument --fast; see tools/soak --help\n");
  EXPECT_EQ(refusal({"--minutes=5", "fast"}),
            "tools/soak: error: unknown argument fast; see tools/soak --help\n");
}

}  // namespace
}  // namespace fogline::test
