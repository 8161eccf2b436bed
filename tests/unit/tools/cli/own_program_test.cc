#include "tools/cli/own_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

#include "tools/processes/child.h"

namespace fogline::cli {
namespace {

using testing::HasSubstr;

/// The output of a process that becomes the program of a verb; "itself" if the process stays as it
/// is.
std::string Become(std::vector<std::string> words) {
  processes::Pipe pipe;
  const pid_t pid = fork();
  if (pid == 0) {
    dup2(pipe.write, STDOUT_FILENO);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    BecomeOwnProgram(static_cast<int>(words.size()), argv.data());
    const ssize_t written = write(STDOUT_FILENO, "itself", 6);
    _exit(written == 6 ? 0 : 1);
  }
  close(pipe.write);
  pipe.write = -1;
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t size = 1; size > 0;) {
    size = read(pipe.read, buffer.data(), buffer.size());
    if (size > 0) text.append(buffer.data(), static_cast<std::size_t>(size));
  }
  int status = 0;
  EXPECT_EQ(waitpid(pid, &status, 0), pid);
  EXPECT_EQ(status, 0);
  return text;
}

TEST(OwnProgramTest, IsTheProgramOfItsVerbWithItsArguments) {
  EXPECT_THAT(Become({"fogline", "calibrate", "--help"}), HasSubstr("fogline calibrate ["));
  EXPECT_THAT(Become({"fogline", "help", "study"}), HasSubstr("fogline study ["));
  EXPECT_THAT(Become({"fogline", "--complete", "study", "--see"}), HasSubstr("--seeds\t"));
}

TEST(OwnProgramTest, IsNoneForOtherVerbs) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"fogline"},
                                                {"fogline", "run", "calibrate"},
                                                {"fogline", "help"},
                                                {"fogline", "help", "run"},
                                                {"fogline", "--complete", "study"},
                                                {"fogline", "help", "study", "more"}}) {
    EXPECT_EQ(Become(words), "itself") << words.back();
  }
}

TEST(OwnProgramTest, IsInTheListOfVerbs) {
  CLI::App app;
  Action action;
  AddOwnPrograms(app, action);
  EXPECT_EQ(app.get_subcommand("calibrate")->get_description(), kCalibrate.purpose);
  EXPECT_EQ(app.get_subcommand("study")->get_description(), kStudy.purpose);
  EXPECT_FALSE(action) << "it runs as another program";
}

}  // namespace
}  // namespace fogline::cli
