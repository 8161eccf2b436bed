// The command line as a person meets it: what it says when asked, and when it cannot follow.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/graph.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Le;
using ::testing::SizeIs;

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string HelpOf(std::vector<std::string> command) {
  command.emplace_back("--help");
  const Outcome help = RunCommand(command);
  EXPECT_EQ(help.code, 0);
  EXPECT_EQ(help.err, "");
  return help.out;
}

/// The verbs, as `fogline --help` lists them.
std::vector<std::string> Verbs() {
  std::vector<std::string> verbs;
  const std::vector<std::string> lines = Lines(HelpOf({Program("fogline")}));
  auto line = std::ranges::find(lines, "Subcommands:");
  for (; line != lines.end() && !line->empty(); ++line) {
    if (line->starts_with("  ")) verbs.push_back(line->substr(2, line->find(' ', 2) - 2));
  }
  return verbs;
}

/// What the command line cannot follow: exit code 2, nothing on stdout, one line on stderr.
std::string ErrorOf(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), Program("fogline"));
  const Outcome outcome = RunCommand(arguments);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(Lines(outcome.err), SizeIs(1));
  return outcome.err;
}

TEST(CommandLineTest, ShowsHelpWithExamplesAndNoLongLineForEveryVerb) {
  const std::vector<std::string> verbs = Verbs();
  ASSERT_THAT(verbs, SizeIs(18));
  std::vector<std::vector<std::string>> commands{{Program("fogline")}};
  for (const std::string& verb : verbs) commands.push_back({Program("fogline"), verb});
  for (const std::vector<std::string>& command : commands) {
    SCOPED_TRACE(command.back());
    const std::string help = HelpOf(command);
    EXPECT_THAT(help, HasSubstr("\nExample"));
    for (const std::string& line : Lines(help)) EXPECT_THAT(line, SizeIs(Le(100U)));
  }
}

TEST(CommandLineTest, ShowsHelpWithAnExampleAndNoLongLineForEveryServiceProgram) {
  for (const RoleInfo& role : kRoles) {
    SCOPED_TRACE(role.name);
    const std::string program = "fogline-" + std::string(role.name);
    const std::string help = HelpOf({Program(program)});
    EXPECT_THAT(help, HasSubstr("\nExample"));
    for (const std::string& line : Lines(help)) EXPECT_THAT(line, SizeIs(Le(100U)));
  }
}

TEST(CommandLineTest, GivesTheRecorderItsLogInItsExample) {
  EXPECT_THAT(HelpOf({Program("fogline-recorder")}), HasSubstr("\n  fogline-recorder --log "));
}

TEST(CommandLineTest, NamesAVerbThatIsNoneAndTheOneThatMayBeMeant) {
  EXPECT_EQ(ErrorOf({"tabel", "scenario/paper.json", "--seeds", "1:3"}),
            "fogline: error: no verb \"tabel\"; did you mean \"table\"? (see fogline --help)\n");
  EXPECT_EQ(ErrorOf({"levitate"}), "fogline: error: no verb \"levitate\" (see fogline --help)\n");
  EXPECT_EQ(ErrorOf({}), "fogline: error: no verb is given (see fogline --help)\n");
}

TEST(CommandLineTest, NamesAnOptionThatIsNoneAndTheOneThatMayBeMeant) {
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--sede=7"}),
            "fogline run: error: no option \"--sede\"; did you mean \"--seed\"? "
            "(see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"--quite"}), "fogline: error: no option \"--quite\" (see fogline --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "scenario/other.json"}),
            "fogline run: error: \"scenario/other.json\" is one argument too many "
            "(see fogline run --help)\n");
}

TEST(CommandLineTest, BeginsEveryRefusalWithTheVerb) {
  EXPECT_EQ(ErrorOf({"run"}),
            "fogline run: error: SCENARIO is required (see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--pace", "fast"}),
            "fogline run: error: --pace: Value fast not in range 0.000000 to 1000.000000 (see "
            "fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--seed"}),
            "fogline run: error: --seed: 1 required TEXT missing (see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"table", "scenario/paper.json", "--seeds", "2:1"}).substr(0, 40),
            "fogline table: error: --seeds 2:1: neith");
  EXPECT_EQ(ErrorOf({"check"}), "fogline check: error: FILE is missing\n");
  EXPECT_EQ(ErrorOf({"check", "--print", "--schema"}),
            "fogline check: error: --print, --schema, --explain and --json exclude each other\n");
}

TEST(CommandLineTest, KeepsControlCharactersOfAWordOutOfItsMessages) {
  EXPECT_EQ(ErrorOf({"ta\nble"}),
            "fogline: error: no verb \"ta\\u000able\"; did you mean \"table\"? "
            "(see fogline --help)\n");
}

}  // namespace
}  // namespace fogline::test
