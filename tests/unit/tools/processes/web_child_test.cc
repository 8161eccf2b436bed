#include "tools/processes/web_child.h"

#include <sys/wait.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::StartsWith;

TEST(PortOfTest, IsTheLastNumberOfAnAddress) {
  EXPECT_EQ(processes::PortOf("http://127.0.0.1:7680/"), "7680");
  EXPECT_EQ(processes::PortOf("http://192.168.1.5:80/drive#token=12ab"), "80");
  EXPECT_EQ(processes::PortOf(""), "0");
}

std::vector<std::string> Options(const std::vector<std::string>& more = {}) {
  std::vector<std::string> options{"--no-browser", "--lcm-url", runtime::FreshMulticastUrl()};
  options.insert(options.end(), more.begin(), more.end());
  return options;
}

TEST(WebChildTest, ListensUntilItIsEnded) {
  processes::WebChild web;
  EXPECT_FALSE(web.Runs());
  EXPECT_FALSE(web.Listens(1, kPatience));
  web.Start(Options({"--port", "0"}));
  ASSERT_TRUE(web.Listens(1, kPatience));
  EXPECT_THAT(web.addresses(), ElementsAre(StartsWith("http://127.0.0.1:")));
  EXPECT_TRUE(web.Runs());
  web.End();
  EXPECT_FALSE(web.Runs());
  EXPECT_EQ(web.how_it_ended(), "");
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "it has ended, and its status is read";
  web.End();
}

TEST(WebChildTest, ReadsItsTokensAndPrintsTheSameAddressesAfterAKill) {
  const std::vector<std::string> seat =
      Options({"--seat", "--tokens-on-stdin", "--listen", "127.0.0.1:0"});
  const std::string tokens = "viewers-viewers-\ndriver-driver-driver\n";
  processes::WebChild web;
  for (int start = 0; start < 2; ++start) {
    web.Start(seat, tokens);
    ASSERT_TRUE(web.Listens(2, kPatience));
    EXPECT_THAT(web.addresses(), ElementsAre(EndsWith("/drive#token=driver-driver-driver"),
                                             EndsWith("/#token=viewers-viewers-")));
    web.Kill();
    while (web.Runs()) std::this_thread::sleep_for(kLookEvery);
    EXPECT_EQ(web.how_it_ended(), "was killed by signal 9 (Killed)");
  }
}

TEST(WebChildTest, ThatEndsAtOnceDoesNotListen) {
  processes::WebChild web;
  web.Start({"--no-such-option"});
  EXPECT_FALSE(web.Listens(1, kPatience));
  EXPECT_FALSE(web.prints());
  while (web.Runs()) std::this_thread::sleep_for(kLookEvery);
  EXPECT_EQ(web.how_it_ended(), "exited with code 2");
}

}  // namespace
}  // namespace fogline::test
