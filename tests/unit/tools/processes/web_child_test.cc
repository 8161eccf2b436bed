#include "tools/processes/web_child.h"

#include <sys/wait.h>

#include <gtest/gtest.h>

#include "tools/processes/child.h"

namespace fogline::test {
namespace {

TEST(PortOfTest, IsTheLastNumberOfAnAddress) {
  EXPECT_EQ(processes::PortOf("http://127.0.0.1:7680/"), "7680");
  EXPECT_EQ(processes::PortOf("http://192.168.1.5:80/drive#token=12ab"), "80");
  EXPECT_EQ(processes::PortOf(""), "0");
}

TEST(EndWebTest, EndsTheChildOnce) {
  const processes::Pipe pipe;
  pid_t pid = processes::StartChild("/bin/sleep", {"60"}, pipe.write);
  const pid_t child = pid;
  processes::EndWeb(pid);
  EXPECT_EQ(pid, -1);
  EXPECT_EQ(waitpid(child, nullptr, WNOHANG), -1) << "it has ended, and its status is read";
  processes::EndWeb(pid);
  EXPECT_EQ(pid, -1);
}

}  // namespace
}  // namespace fogline::test
