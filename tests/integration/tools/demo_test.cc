// tools/demo calls tools/setup and tools/build for what it needs, and names commands and files that
// exist. In these tests it uses the programs of this build, and installs and compiles nothing.
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/web/viewed.h"
#include "tests/support/command.h"
#include "tests/support/web_client.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A folder in which tools/demo runs. The folder's own tools/setup installs nothing, and its own
/// tools/build only makes links to the programs of this build. Both write their calls into the
/// file `calls`.
class DemoFolder {
 public:
  DemoFolder() {
    const std::filesystem::path tools = folder_.path() / "tools";
    std::filesystem::create_directory(tools);
    for (const char* script : {"demo", "lock"}) {
      std::filesystem::copy_file(SourceDirectory() / "tools" / script, tools / script);
    }
    Write("setup", "");
    Write("build", BuildCommands());
    std::filesystem::create_directory_symlink(SourceDirectory() / "scenario",
                                              folder_.path() / "scenario");
  }

  static std::string BuildCommands() {
    return "mkdir -p build; ln -sfn " + ProgramDirectory().string() + " build/bin";
  }
  /// Makes the script tools/NAME. It writes its call into `calls`, and then executes `commands`.
  void Write(const std::string& name, const std::string& commands) const {
    const std::filesystem::path script = folder_.path() / "tools" / name;
    std::ofstream(script) << "#!/bin/sh\necho \"$0 $*\" >>calls\n" << commands << "\n";
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
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

constexpr const char* kBuildNotice =
    "building the programs for the experiment: two to three minutes";
constexpr const char* kPageNotice = "building the programs for the page of a run";
constexpr const char* kCalls =
    "tools/setup run\ntools/build fogline_run\ntools/build fogline_demo\n";

TEST(DemoTest, BuildsOnlyItsPartsAndSaysAtFirstThatThisTakesLong) {
  const DemoFolder folder;
  const Outcome first = RunCommand(folder.Typed("tools/demo"));
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr(kBuildNotice));
  EXPECT_EQ(Content(folder.path() / "calls"), kCalls);
  const Outcome again = RunCommand(folder.Typed("tools/demo"));
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, Not(HasSubstr(kBuildNotice)));
  EXPECT_THAT(again.err, Not(HasSubstr(kPageNotice)));
}

TEST(DemoTest, ShowsItsResultBeforeItBuildsWhatTheResultDoesNotNeed) {
  const DemoFolder folder;
  folder.Write("build",
               "[ $1 = fogline_run ] || exit 3\n"
               "mkdir -p build/bin\n"
               "cd build/bin\n"
               "ln -s " +
                   ProgramDirectory().string() +
                   "/fogline-* .\n"
                   "rm fogline-web fogline-relay\n"
                   // fogline is a copy and no link, so it looks for the other programs here.
                   "cp " +
                   Program("fogline") + " .");
  const Outcome demo = RunCommand(folder.Typed("tools/demo"));
  EXPECT_EQ(demo.code, 3) << demo.out << demo.err;
  EXPECT_EQ(Content(folder.path() / "calls"), kCalls);
  EXPECT_THAT(demo.out, HasSubstr("published SI"));
  EXPECT_THAT(demo.out, HasSubstr("logs:   logs/demo/"));
  EXPECT_EQ(NamedAs("report", demo.out), "logs/demo/report.html");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "logs/demo/report.html"));
  EXPECT_THAT(demo.err, HasSubstr(kPageNotice));
  // The last build failed, so the program of the view is missing, and the demo must not name it.
  EXPECT_EQ(NamedAs("view", demo.out), "");
}

TEST(DemoTest, TwoAtOnceRunOneAfterTheOther) {
  const DemoFolder folder;
  const std::string link = folder.BuildCommands();
  folder.Write("build", link + "; until [ -e go ]; do sleep 0.05; done\n" +
                            "[ $1 = fogline_run ] || { sleep 0.5; touch page; }");
  Background first(folder.Typed("tools/demo"));
  ASSERT_TRUE(ComesToHave("tools/build fogline_run\n", folder.path() / "calls"));
  Background second(folder.Typed("tools/demo"));
  EXPECT_TRUE(second.WaitForErr("waiting for another tools/demo in this folder ..."));
  EXPECT_EQ(Content(folder.path() / "calls"), "tools/setup run\ntools/build fogline_run\n");
  // The second demo must begin only after the first demo has ended.
  folder.Write("setup", "[ ! -e page ] || echo after the page >>calls");
  std::ofstream(folder.path() / "go") << "";
  for (Background* demo : {&first, &second}) {
    EXPECT_EQ(demo->Wait(), 0) << demo->Err();
    EXPECT_THAT(demo->Out(), HasSubstr("report: logs/demo/report.html"));
  }
  EXPECT_EQ(Content(folder.path() / "calls"),
            std::string(kCalls) +
                "tools/setup run\nafter the page\n"
                "tools/build fogline_run\ntools/build fogline_demo\n");
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
