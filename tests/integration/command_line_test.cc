// The command line as a person meets it: what it says when asked, and when it cannot follow.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::SizeIs;

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
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
