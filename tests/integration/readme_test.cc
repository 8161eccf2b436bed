// The README says what the code says.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "services/runtime/bus.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

std::string ReadSource(const std::string& file) {
  std::ifstream in(SourceDirectory() / file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(ReadmeTest, HasTheTablesOfTheGraph) {
  const Outcome graph = RunCommand({Program("fogline"), "graph"});
  ASSERT_EQ(graph.code, 0);
  EXPECT_NE(ReadSource("README.md").find(graph.out), std::string::npos)
      << "put this into README.md:\n"
      << graph.out;
}

TEST(ReadmeTest, ShowsThePartThatTheSwapTestBuilds) {
  std::string source = ReadSource("tests/integration/external_driver/my_driver.cc");
  source.erase(0, source.find("#include"));  // drops the comment at the top
  EXPECT_NE(ReadSource("services/README.md").find(source), std::string::npos) << source;
}

TEST(ReadmeTest, BuildsAndDrivesAPartByTheCommandsOfSwapAPart) {
  // GIVEN a clone with its build on a machine without make, and a home folder of its own
  const ScratchFolder folder;
  for (const char* part : {"scenario", "tests"}) {
    std::filesystem::create_directory_symlink(SourceDirectory() / part, folder.path() / part);
  }
  std::filesystem::create_directory_symlink(FOGLINE_BINARY_DIR, folder.path() / "build");
  // WHEN a shell executes the README's commands
  const std::string readme = ReadSource("README.md");
  const std::size_t begin = readme.find("\n## Swap a part");
  const std::string section = readme.substr(begin, readme.find("\n## ", begin + 1) - begin);
  std::string commands = "set -e; cd " + folder.path().string() +
                         "; export HOME=$PWD PATH=" + ProgramDirectory().string() +
                         ":$PATH LCM_DEFAULT_URL='" + FreshMulticastUrl() + "'\n";
  static const std::regex kCommand("\n    ([^\n]*)");
  for (std::sregex_iterator at(section.begin(), section.end(), kCommand), end; at != end; ++at) {
    commands += (*at)[1].str() + "\n";
  }
  std::vector<std::string> command = WithoutMake(folder);
  command.insert(command.end(), {"bash", "-c", commands});
  const Outcome outcome = RunCommand(command);
  // THEN the part that they build drives the car
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("scenario/paper.json: 500 steps"), std::string::npos) << outcome.out;
}

TEST(ReadmeTest, IsShortAndNamesOnlyFilesThatAreThere) {
  const std::string readme = ReadSource("README.md");
  EXPECT_LE(std::ranges::count(readme, '\n'), 180);
  std::size_t links = 0;
  for (std::size_t at = readme.find("]("); at != std::string::npos;
       at = readme.find("](", at + 1)) {
    const std::string link = readme.substr(at + 2, readme.find(')', at) - at - 2);
    EXPECT_TRUE(std::filesystem::exists(SourceDirectory() / link)) << link;
    ++links;
  }
  EXPECT_GE(links, 5U);
}

TEST(ReadmeTest, ItsCommandsLeaveNoFileThatGitDoesNotKnow) {
  // GIVEN those parts of a clone that these commands need
  const ScratchFolder clone;
  for (const char* part : {".gitignore", "scenario", "docs"}) {
    std::filesystem::copy(SourceDirectory() / part, clone.path() / part,
                          std::filesystem::copy_options::recursive);
  }
  const auto in_clone = [&](const std::string& command) {
    const Outcome outcome =
        RunCommand({"bash", "-c",
                    "cd " + clone.path().string() + " && PATH=" + ProgramDirectory().string() +
                        ":$PATH && " + command});
    EXPECT_EQ(outcome.code, 0) << command << "\n" << outcome.err;
    return outcome.out;
  };
  in_clone("git init -q && git add -A");
  in_clone("fogline table scenario/paper.json --logs logs/demo");  // as tools/demo does
  // WHEN a shell executes the README's commands
  const std::string readme = ReadSource("README.md");
  static const std::regex kCommand(
      "`(fogline (run|table|sweep|calibrate|study|report) [^`]*(scenario/|--out |logs/)[^`]*)`");
  std::size_t commands = 0;
  for (std::sregex_iterator at(readme.begin(), readme.end(), kCommand), end; at != end; ++at) {
    // These two take long with many seeds. Few seeds give the same files.
    const bool takes_long = (*at)[2] == "study" || (*at)[2] == "calibrate";
    in_clone((*at)[1].str() + (takes_long ? " --seeds 1:2" : ""));
    ++commands;
  }
  EXPECT_GE(commands, 6U);
  std::smatch words;
  ASSERT_TRUE(std::regex_search(readme, words, std::regex("`export LOG (--out [^`]*)`")));
  in_clone("fogline export logs/paper-1.lcm " + words[1].str());
  ASSERT_TRUE(std::regex_search(readme, words, std::regex("\n    lcm-logger ([^ ]*) &")));
  in_clone("cp logs/paper-1.lcm " + words[1].str());
  // THEN git finds no new files
  EXPECT_EQ(in_clone("git ls-files --others --exclude-standard"), "");
}

}  // namespace
}  // namespace fogline::test
