#include "tools/cli/verb_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/interrupt.h"
#include "services/runtime/process/version.h"

namespace fogline::cli {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Adds a verb that ends in the way that its argument names.
void AddEnd(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("end", "Ends in one way or another");
  const auto how = std::make_shared<std::string>();
  verb->add_option("HOW", *how)->required();
  verb->callback([&action, how] {
    action = [how]() -> int {
      if (*how == "arguments") throw InputError("error: --how: wrong");
      if (*how == "file") throw InputError("paper.json: error: no such field");
      if (*how == "interrupted") throw Interrupted("interrupted at step 7");
      if (*how == "check") throw CheckFailed("a check failed");
      if (*how == "failure") throw std::runtime_error("the relay is gone");
      fmt::print("{}\n", *how);
      return *how == "problem" ? kCheckFailed : kDone;
    };
  });
}

struct Ended {
  int code;
  std::string out;
  std::string err;
};

Ended Call(std::vector<std::string> words, bool one_verb = false) {
  words.insert(words.begin(), one_verb ? "fogline-end" : "fogline");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const auto argc = static_cast<int>(words.size());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code =
      one_verb ? RunOneVerb(argc, argv.data(), AddEnd) : RunVerbs(argc, argv.data(), {AddEnd});
  std::fflush(stdout);
  return {.code = code,
          .out = testing::internal::GetCapturedStdout(),
          .err = testing::internal::GetCapturedStderr()};
}

void ExpectError(const std::string& how, int code, const std::string& err) {
  const Ended ended = Call({"end", how});
  EXPECT_EQ(ended.code, code) << how;
  EXPECT_EQ(ended.err, err + "\n");
  EXPECT_EQ(ended.out, "") << how;
}

TEST(VerbProgramTest, EndsWithTheCodeOfItsVerb) {
  const Ended good = Call({"end", "well"});
  EXPECT_EQ(good.code, 0);
  EXPECT_EQ(good.out, "well\n");
  EXPECT_EQ(good.err, "");
  EXPECT_EQ(Call({"end", "problem"}).code, 1);
}

TEST(VerbProgramTest, EndsWithTheCodeOfItsErrorAndOneLine) {
  ExpectError("check", 1, "fogline end: error: a check failed");
  ExpectError("arguments", 2, "fogline end: error: --how: wrong");
  ExpectError("file", 2, "paper.json: error: no such field");
  ExpectError("failure", 3, "fogline end: error: the relay is gone");
  ExpectError("interrupted", 130, "fogline end: interrupted at step 7");
}

TEST(VerbProgramTest, RefusesABadCommandLine) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"edn"}, {"end"}}) {
    const Ended ended = Call(words);
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr(": error: "));
    EXPECT_EQ(ended.out, "");
  }
  EXPECT_EQ(Call({"levitate", "--help"}).code, 2);
}

TEST(VerbProgramTest, ExplainsItself) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{}, {"--help"}}) {
    const Ended help = Call(words);
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.out, HasSubstr("Usage: fogline ["));
    EXPECT_THAT(help.out, HasSubstr("Ends in one way or another"));
    EXPECT_EQ(help.err, "");
  }
  EXPECT_EQ(Call({"--version"}).out, runtime::VersionText() + "\n");
}

TEST(VerbProgramTest, CompletesItsCommandLineAndRunsNoVerb) {
  EXPECT_EQ(Call({"--complete", "e"}).out, "end\tEnds in one way or another\n");
  EXPECT_EQ(Call({"--complete", "end", "problem"}).code, 0);
  EXPECT_EQ(Call({"--complete", "--he"}, true).out, Call({"--complete", "end", "--he"}).out);
  EXPECT_THAT(Call({"--complete", "--he"}, true).out, StartsWith("--help\t"));
}

TEST(VerbProgramTest, OfOneVerbHasNoVerbInItsCommandLine) {
  const Ended good = Call({"well"}, true);
  EXPECT_EQ(good.code, 0);
  EXPECT_EQ(good.out, "well\n");
  EXPECT_THAT(Call({}, true).err, StartsWith("fogline end: error: HOW is required"));
  EXPECT_EQ(Call({"--version"}, true).out, runtime::VersionText() + "\n");
  EXPECT_THAT(Call({"--help"}, true).out, HasSubstr("Usage: fogline end ["));
}

}  // namespace
}  // namespace fogline::cli
