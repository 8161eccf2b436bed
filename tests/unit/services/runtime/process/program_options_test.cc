#include "services/runtime/process/program_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/exit_code.h"
#include "tests/support/input_errors.h"

namespace fogline::test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::optional<std::int64_t> Read(const std::string& text) {
  CLI::App app;
  std::optional<std::int64_t> run_id;
  runtime::AddRunIdOption(app, "--run-id", run_id, "the run");
  app.parse(std::vector<std::string>{text, "--run-id"});  // CLI11 expects the reverse order
  return run_id;
}

/// A program with one option of each kind that has limits.
struct Program {
  std::string file = "here";
  std::size_t count = 4;
  double wait_s = 60;
  double speed = 1;
  std::string color = "red";
  bool quiet = false;
  std::string out;  // what Read() printed
  std::string error;

  std::optional<int> Read(std::vector<std::string> words) {
    runtime::ProgramOptions options("fogline-it", "Does it.", "1.2.3");
    options.Text("--file", file, "The file", runtime::ProgramOptions::Help::kWithDefault);
    options.Count("--count", count, "How many", 1, 256);
    options.Seconds("--wait", wait_s, "How long", 1e6);
    options.Number("--speed", speed, "How fast", -2, 2.5);
    options.Choice("--color", color, "Which", {"red", "green"});
    options.Flag("--quiet", quiet, "Say nothing");
    options.Footer("Exit codes: 0 done.");
    words.insert(words.begin(), "fogline-it");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const std::optional<int> exit_code = options.Parse(static_cast<int>(argv.size()), argv.data());
    out = ::testing::internal::GetCapturedStdout();
    error = ::testing::internal::GetCapturedStderr();
    return exit_code;
  }
};

TEST(ProgramOptionsTest, ReadsWhatIsSaidAndKeepsTheDefaults) {
  Program program;
  EXPECT_EQ(program.Read({"--count", "256", "--speed", "-1.5", "--color", "green", "--quiet"}),
            std::nullopt);
  EXPECT_EQ(program.count, 256U);
  EXPECT_EQ(program.speed, -1.5);
  EXPECT_EQ(program.color, "green");
  EXPECT_TRUE(program.quiet);
  EXPECT_EQ(program.file, "here");
  EXPECT_EQ(program.wait_s, 60);
  EXPECT_EQ(program.out + program.error, "");
}

TEST(ProgramOptionsTest, RefusesWhatIsOutOfRange) {
  const std::vector<std::vector<std::string>> wrong = {
      {"--count", "0"},  {"--count", "257"}, {"--count", "x"},    {"--wait", "-1"},
      {"--wait", "nan"}, {"--wait", "1e7"},  {"--unknown"},       {"more"},
      {"--speed", "-3"}, {"--speed", "nan"}, {"--color", "blue"}, {"--color", "Red"},
      {"--file", ""},    {"--quiet=3"},      {"--file"}};
  for (const std::vector<std::string>& words : wrong) {
    Program program;
    EXPECT_EQ(program.Read(words), kBadInput) << words.back();
    EXPECT_THAT(program.error, StartsWith("fogline-it: error: "));
    EXPECT_THAT(program.error, HasSubstr(words.front().substr(0, words.front().find('='))));
    EXPECT_THAT(program.error, EndsWith(" (see fogline-it --help)\n"));
    EXPECT_EQ(program.out, "");
  }
}

TEST(ProgramOptionsTest, PrintsHelpAndVersion) {
  Program program;
  EXPECT_EQ(program.Read({"--version"}), kDone);
  EXPECT_EQ(program.out, "1.2.3\n");
  EXPECT_EQ(program.Read({"--help"}), kDone);
  for (const char* part : {"Does it.", "=here", "[1 - 256]", "Exit codes: 0 done."}) {
    EXPECT_THAT(program.out, HasSubstr(part));
  }
  EXPECT_EQ(program.error, "");
}

TEST(RunIdOptionTest, TakesEveryIdThatARunCanHave) {
  EXPECT_EQ(Read("1"), 1);
  EXPECT_EQ(Read("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
}

TEST(RunIdOptionTest, RefusesWhatIsNoId) {
  for (const char* text : {"0", "-5", "x", "1.5", "9223372036854775808", "99999999999999999999"}) {
    EXPECT_THAT(ErrorOf<CLI::ParseError>([text] { Read(text); }), HasSubstr(text));
  }
}

}  // namespace
}  // namespace fogline::test
