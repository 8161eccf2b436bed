// The last lines of tools/demo name commands and files that exist. tools/demo uses the programs of
// this build, and installs and builds nothing.
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/runtime/transport/bus.h"
#include "tests/integration/web/viewed.h"
#include "tests/support/command.h"
#include "tests/support/web_client.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;

/// A folder in which tools/demo runs. The folder's own tools/setup and tools/build do nothing.
class DemoFolder {
 public:
  DemoFolder() {
    const std::filesystem::path tools = folder_.path() / "tools";
    std::filesystem::create_directory(tools);
    std::filesystem::copy_file(SourceDirectory() / "tools/demo", tools / "demo");
    for (const char* script : {"setup", "build"}) {
      std::ofstream(tools / script) << "#!/bin/sh\n";
      std::filesystem::permissions(tools / script, std::filesystem::perms::owner_all);
    }
    std::filesystem::create_directory_symlink(SourceDirectory() / "scenario",
                                              folder_.path() / "scenario");
    std::filesystem::create_directory(folder_.path() / "build");
    std::filesystem::create_directory_symlink(ProgramDirectory(), folder_.path() / "build/bin");
  }

  /// A command line for bash, as a user types it in this folder.
  std::vector<std::string> Typed(const std::string& line) const {
    return {"env", "LCM_DEFAULT_URL=" + runtime::FreshMulticastUrl(), "bash", "-c",
            "cd " + folder_.path().string() + " && " + line};
  }
  std::filesystem::path path() const { return folder_.path(); }

 private:
  ScratchFolder folder_;
};

/// What the demo says at its end about `name`. The line is "NAME:   WHAT (more words)".
std::string NamedAs(const std::string& name, const std::string& said) {
  const std::regex line("(?:^|\n)" + name + ": +([^(\n]*[^( \n])");
  std::smatch found;
  return std::regex_search(said, found, line) ? found[1].str() : "";
}

TEST(DemoTest, NamesItsFilesAndTheCommandThatShowsARunInABrowser) {
  const DemoFolder folder;
  const Outcome demo = RunCommand(folder.Typed("tools/demo"));
  ASSERT_EQ(demo.code, 0) << demo.out << demo.err;
  const std::string last = demo.out.substr(demo.out.rfind('\n', demo.out.size() - 2) + 1);

  EXPECT_THAT(Content(folder.path() / NamedAs("report", demo.out)), HasSubstr("</html>"));
  std::smatch metrics;
  ASSERT_TRUE(std::regex_search(demo.out, metrics, std::regex("try: ([^)\n]*)\\)"))) << demo.out;
  EXPECT_EQ(RunCommand(folder.Typed(metrics[1])).code, 0) << metrics[1];

  const std::string command = NamedAs("view", last);
  Viewed viewed(Viewed::Started{folder.Typed("exec " + command + " --no-browser --port 0")});
  ASSERT_NE(viewed.port(), 0) << last << viewed.process().Err();
  const std::string page = Exchange(viewed.port(), GetRequest(viewed.port(), "/"));
  EXPECT_EQ(StatusOf(page), 200) << page;
  EXPECT_THAT(page, HasSubstr("<title>Fogline</title>"));
  WebClient client(viewed.port());
  const nlohmann::json log = ReceiveOp(client, "log");
  EXPECT_THAT(command, ::testing::EndsWith("/" + log["file"].get<std::string>()));
  const auto scenario = nlohmann::json::parse(Content(SourceDirectory() / "scenario/paper.json"));
  EXPECT_EQ(log["last_step"], scenario["steps"].get<int>() - 1);
  EXPECT_EQ(log["complete"], true);
  EXPECT_EQ(viewed.End(), 0);
}

}  // namespace
}  // namespace fogline::test
