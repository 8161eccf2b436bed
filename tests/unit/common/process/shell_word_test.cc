#include "common/process/shell_word.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

TEST(ShellWordTest, LeavesAPlainWordAsItIs) {
  EXPECT_EQ(ShellWord("/opt/fogline/bin/fogline-acc"), "/opt/fogline/bin/fogline-acc");
  EXPECT_EQ(ShellWord("--set=a_1,b+2"), "--set=a_1,b+2");
}

TEST(ShellWordTest, IsOneWordForAShellWhateverItHas) {
  for (const std::string text :
       {"", "a b", "it's", "$HOME", "a;b", "`x`", "\"", "\\", "~/a", "*"}) {
    EXPECT_EQ(RunCommand({"sh", "-c", "printf %s " + ShellWord(text)}).out, text);
  }
}

}  // namespace
}  // namespace fogline::test
