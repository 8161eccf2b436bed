#include "scenario/io/files/sumo_files.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// A folder with a scenario whose leader comes from SUMO, and SUMO's files.
class SumoFilesTest : public testing::Test {
 protected:
  SumoFilesTest() {
    Write("s.json", R"({"version": 1, "lead": {"profile": "sumo", "sumo": {
 "net_file": "a.net.xml",
 "route_file": "a.rou.xml", "behind": "x"}}})");
    Write("a.net.xml", "<net>\n</net>\n");
    Write("a.rou.xml", "<routes/>");
  }
  void Write(const std::string& name, std::string_view text) const {
    std::ofstream(folder_.File(name), std::ios::binary) << text;
  }
  SumoSection Load(const std::vector<std::string>& overrides = {}) const {
    return LoadScenario(folder_.File("s.json"), overrides).lead.sumo;
  }
  /// The error text that a user sees, without the folder.
  std::string ErrorWith(const std::string& name, std::string_view text) const {
    Write(name, text);
    try {
      Load();
      return "";
    } catch (const ScenarioError& error) {
      std::string what = error.what();
      const std::string prefix = folder_.path().string() + "/";
      for (std::size_t at = what.find(prefix); at != std::string::npos; at = what.find(prefix)) {
        what.erase(at, prefix.size());
      }
      return what.substr(0, what.find('\n'));
    }
  }

  const test::ScratchFolder folder_;
};

TEST_F(SumoFilesTest, BecomeLinesOfTheScenario) {
  const SumoSection sumo = Load();
  EXPECT_THAT(sumo.net, ElementsAre("<net>", "</net>"));
  EXPECT_THAT(sumo.routes, ElementsAre("<routes/>"));
}

TEST_F(SumoFilesTest, LoseTabsAndCarriageReturns) {
  Write("a.net.xml", "<net>\r\n\t<edge/>\r\n</net>");
  EXPECT_THAT(Load().net, ElementsAre("<net>", " <edge/>", "</net>"));
}

TEST_F(SumoFilesTest, HaveLongLinesBrokenAtASpace) {
  std::string numbers = "shape=\"";
  while (numbers.size() < 9000) numbers += "1234.00,5678.00 ";
  Write("a.net.xml", numbers + "\"\n");
  const std::vector<std::string> lines = Load().net;
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0] + ' ' + lines[1] + ' ' + lines[2], numbers + '"');
  for (const std::string& line : lines) EXPECT_LE(line.size(), 4096U);
}

TEST_F(SumoFilesTest, AreNotReadIfTheScenarioHasTheLines) {
  const SumoSection sumo = Load({"/lead/sumo/net=[\"<other/>\"]", "/lead/sumo/route_file=\"\""});
  EXPECT_THAT(sumo.net, ElementsAre("<other/>"));
  EXPECT_THAT(sumo.routes, IsEmpty());
}

TEST_F(SumoFilesTest, AreRefusedIfTheyCannotBeReadOrCannotBePartOfAScenario) {
  EXPECT_EQ(ErrorWith("a.rou.xml", "caf\xe9"),
            "s.json:3:16: error: /lead/sumo/route_file: a.rou.xml is no UTF-8");
  EXPECT_EQ(ErrorWith("a.rou.xml", "a\x01"),
            "s.json:3:16: error: /lead/sumo/route_file: a.rou.xml has a control character");
  EXPECT_EQ(ErrorWith("a.rou.xml", std::string(5000, 'a')),
            "s.json:3:16: error: /lead/sumo/route_file: a.rou.xml has more than 4096 characters "
            "without a space");
  Write("a.rou.xml", "<routes/>");
  std::filesystem::remove(folder_.File("a.net.xml"));
  EXPECT_THAT(ErrorWith("b.xml", ""),
              testing::StartsWith("s.json:2:14: error: /lead/sumo/net_file: a.net.xml "));
}

}  // namespace
}  // namespace fogline
