// bash, zsh and fish complete command lines of an installed Fogline when a person presses the tab
// key.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/integration/drive/in_terminal.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

/// A shell, and the first line that the test types into it. This line sets a prompt. The line does
/// not contain the text of the prompt, so the test does not take the echo of the line for the
/// prompt.
struct Shell {
  std::string name;
  std::string command;
  std::string first_line;
};
constexpr const char* kPrompt = "ready> ";

void PrintTo(const Shell& shell, std::ostream* out) { *out << shell.name; }

/// A command line that a person types, and its last word after the tab key was pressed.
struct Case {
  std::string typed;
  std::string word;
};
const std::vector<Case> kCases{
    {"fogline met", "metrics"},
    {"fogline run scenario/pap", "scenario/paper.json"},
    {"fogline run scenario/paper.json --resu", "--resume"},
    {"fogline run scenario/paper.json --set /arb", "/arbitrator/"},
    {"fogline run scenario/paper.json --set /arbitrator/thresh", "/arbitrator/threshold="},
    {"fogline run scenario/paper.json --set /arbitrator/policy=avail",
     "/arbitrator/policy=availability"},
    {"fogline replay run.lcm --role arb", "arbitrator"},
    {"fogline study --scen", "--scenarios"},
    {"fogline-driver --lcm", "--lcm-url"},
};

class ShellCompletionTest : public testing::TestWithParam<Shell> {
 protected:
  void SetUp() override {
    const Outcome install = RunCommand({"cmake", "--install", FOGLINE_BINARY_DIR, "--prefix",
                                        folder_.path().string(), "--component", "fogline"});
    ASSERT_EQ(install.code, 0) << install.err;
  }

  std::vector<std::string> Start() const {
    const std::string share = folder_.File("share");
    return {"/usr/bin/env",
            "-i",
            "TERM=xterm",
            "LANG=C.UTF-8",
            "HOME=" + folder_.path().string(),
            "PATH=" + folder_.File("bin") + ":/usr/bin:/bin",
            "XDG_DATA_DIRS=" + share + ":/usr/share",
            "SHARE=" + share,
            "sh",
            "-c",
            "stty rows 24 cols 200; exec " + GetParam().command};
  }

  ScratchFolder folder_;
};

TEST_P(ShellCompletionTest, CompletesVerbsOptionsFieldsRolesAndFiles) {
  InTerminal shell(Start());
  const auto shows = [&shell](const std::string& text) {
    return shell.WaitUntil([&] { return shell.text().find(text) != std::string::npos; });
  };
  shell.Type(GetParam().first_line + "\r");
  ASSERT_TRUE(shows(kPrompt)) << shell.text();
  for (const Case& line : kCases) {
    // Ctrl-A moves the cursor to the beginning of the line. printf shows the words of the completed
    // line.
    shell.Type(line.typed + "\t\001printf '<%s>' \r");
    EXPECT_TRUE(shows("<" + line.word + ">")) << line.typed << "\n" << shell.text();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shells, ShellCompletionTest,
    testing::Values(Shell{"bash", "bash --norc --noprofile -i",
                          "source /usr/share/bash-completion/bash_completion; PS1='rea''dy> '"},
                    Shell{"zsh", "zsh -f -i",
                          "fpath=($SHARE/zsh/vendor-completions $fpath); autoload -U compinit; "
                          "compinit -u -d $HOME/dump; PS1='rea''dy> '"},
                    Shell{"fish", "fish -i", "function fish_prompt; printf 'rea%s> ' dy; end"}),
    [](const auto& shell) { return shell.param.name; });

}  // namespace
}  // namespace fogline::test
