// The README and the pages in docs/ agree with the code, and with the output of their commands.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"
#include "tests/support/pages.h"

namespace fogline::test {
namespace {

std::string ReadSource(const std::string& file) { return Content(SourceDirectory() / file); }

/// A clone in which the commands of a page are executed. It has its own scenarios and build folder,
/// and the programs and tests of this build. Git has added all files that exist at the beginning.
class Clone {
 public:
  Clone() {
    for (const char* part : {".gitignore", "scenario", "docs"}) {
      std::filesystem::copy(SourceDirectory() / part, folder_.path() / part,
                            std::filesystem::copy_options::recursive);
    }
    std::filesystem::create_directory_symlink(SourceDirectory() / "tests",
                                              folder_.path() / "tests");
    const std::filesystem::path build = folder_.path() / "build";
    std::filesystem::create_directory(build);
    for (const auto& entry : std::filesystem::directory_iterator(FOGLINE_BINARY_DIR)) {
      std::filesystem::create_symlink(entry.path(), build / entry.path().filename());
    }
    Must("git init -q && git add -A");
  }

  /// Executes a script in the clone. In the script the command `make` fails. HOME is a folder of
  /// the clone, without files of a user.
  Outcome Run(const std::string& script) const {
    std::vector<std::string> command = WithoutMake(home_);
    command.insert(command.end(), {"bash", "-c",
                                   "set -e; cd " + folder_.path().string() +
                                       "; export HOME=" + home_.path().string() + " PATH=" +
                                       ProgramDirectory().string() + ":$PATH LCM_DEFAULT_URL='" +
                                       runtime::FreshMulticastUrl() + "'\n" + script});
    return RunCommand(command, 2 * kPatience);
  }

  /// Executes a command that must succeed. @return its output
  std::string Must(const std::string& command) const {
    const Outcome outcome = Run(command);
    EXPECT_EQ(outcome.code, 0) << command << "\n" << outcome.out << outcome.err;
    return outcome.out;
  }

  /// The files that are new and that git does not ignore.
  std::string NewFiles() const { return Must("git ls-files --others --exclude-standard"); }

 private:
  ScratchFolder folder_;
  ScratchFolder home_;
};

/// The line that ScriptOf() prints before the commands of a block.
std::string Mark(std::size_t block) { return "@@ block " + std::to_string(block) + " @@\n"; }

/// The commands of all blocks as one script.
std::string ScriptOf(const std::vector<Block>& blocks) {
  std::string script;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (blocks[i].commands) script += "printf '" + Mark(i) + "'\n" + blocks[i].text;
  }
  return script;
}

/// The lines of a text without the parts that may differ: a time, such as " in 0.62 s", with the
/// rest of its line, and spaces at the end of a line.
std::vector<std::string> Comparable(const std::string& text) {
  static const std::regex kTime(" in [0-9.]+ s.*");
  static const std::regex kSpaces(" +$");
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(std::regex_replace(std::regex_replace(line, kTime, " in"), kSpaces, ""));
  }
  return lines;
}

/// The reason why the lines `shown` do not agree with the lines `printed`; "" if they agree. In
/// `shown` a line "..." stands for any number of lines.
std::string WhyNotShown(const std::string& shown, const std::string& printed) {
  constexpr const char* kLeftOut = "...";
  const std::vector<std::string> lines = Comparable(printed);
  auto next = lines.begin();
  bool left_out = false;
  for (const std::string& line : Comparable(shown)) {
    if (line == kLeftOut) {
      left_out = true;
      continue;
    }
    const auto place = left_out ? std::find(next, lines.end(), line) : next;
    if (place == lines.end()) return "\"" + line + "\" is not printed there";
    if (*place != line) return "\"" + line + "\" is shown for \"" + *place + "\"";
    next = place + 1;
    left_out = false;
  }
  return left_out || next == lines.end() ? "" : "\"" + *next + "\" is not shown";
}

/// Expects that each block "text" shows the output of the commands before this block. @return the
/// number of lines that were compared
std::ptrdiff_t ExpectShows(const std::vector<Block>& blocks, const std::string& out) {
  std::ptrdiff_t compared = 0;
  std::string printed;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (blocks[i].commands) {
      const std::size_t begin = out.find(Mark(i));
      const std::size_t after = begin == std::string::npos ? out.size() : begin + Mark(i).size();
      printed = out.substr(after, out.find("@@ block ", after) - after);
      continue;
    }
    EXPECT_EQ(WhyNotShown(blocks[i].text, printed), "") << blocks[i].text << "for\n" << printed;
    compared += std::ranges::count(blocks[i].text, '\n');
  }
  return compared;
}

TEST(ShownOutputTest, IsWholeOrHasALineWhereLinesAreLeftOut) {
  const std::string printed = "head\n1 2 3\n\n4 5 6\ntail\n";
  for (const char* shown : {"head\n1 2 3\n\n4 5 6\ntail\n", "head\n...\ntail\n",
                            "...\n1 2 3\n...\n", "head\n1 2 3\n...\n4 5 6\ntail\n...\n"}) {
    EXPECT_EQ(WhyNotShown(shown, printed), "") << shown;
  }
  EXPECT_EQ(WhyNotShown("head\n1 2\n...\n", printed), "\"1 2\" is shown for \"1 2 3\"");
  EXPECT_EQ(WhyNotShown("...\n1 2\n...\n", printed), "\"1 2\" is not printed there");
  EXPECT_EQ(WhyNotShown("head\n\n...\n", printed), "\"\" is shown for \"1 2 3\"");
  EXPECT_EQ(WhyNotShown("head\n1 2 3\n", printed), "\"\" is not shown");
  EXPECT_EQ(WhyNotShown("...\ntail\nmore\n", printed), "\"more\" is not printed there");
}

TEST(ShownOutputTest, MayDifferBehindATimeAndInSpacesAtTheEndOfALine) {
  EXPECT_EQ(WhyNotShown("9 rows in 0.1 s, 90 rows per second\n", "9 rows in 2.34 s, 4 rows\n"), "");
  EXPECT_NE(WhyNotShown("9 rows in 0.1 s\n", "8 rows in 0.1 s\n"), "");
  EXPECT_EQ(WhyNotShown("steps  500\n", "steps  500 \n"), "");
}

TEST(ReadmeTest, HasTheRolesOfTheGraphAndTheArchitectureBothTables) {
  const Outcome graph = RunCommand({Program("fogline"), "graph", "--markdown"});
  ASSERT_EQ(graph.code, 0);
  EXPECT_NE(ReadSource("docs/architecture.md").find(graph.out), std::string::npos)
      << "call: fogline graph --into README.md docs/architecture.md";
  const std::string roles = graph.out.substr(0, graph.out.find("\n\n") + 1);
  EXPECT_NE(ReadSource("README.md").find(roles), std::string::npos)
      << "call: fogline graph --into README.md docs/architecture.md";
}

TEST(DocsTest, ShowThePartThatTheSwapTestBuilds) {
  std::string source = ReadSource("tests/integration/external_driver/my_driver.cc");
  source.erase(0, source.find("#include"));  // drops the comment at the top
  EXPECT_NE(ReadSource("docs/extending.md").find(source), std::string::npos) << source;
}

TEST(DocsTest, ThePartOfExtendingIsBuiltAndDrivesTheCarByTheCommandsThere) {
  const Clone clone;
  const std::vector<Block> blocks = BlocksOf(ReadSource("docs/extending.md"));
  // WHEN a shell executes the commands of the page
  const Outcome outcome = clone.Run(ScriptOf(blocks));
  // THEN the commands have built a driver, and this driver drives the car
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("scenario/paper.json: 500 steps"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("verified: world radar lidar"), std::string::npos) << outcome.out;
  EXPECT_EQ(clone.NewFiles(), "");
}

TEST(DocsTest, TheCommandsOfGettingStartedPrintWhatThePageShows) {
  const Clone clone;
  std::string page = ReadSource("docs/getting-started.md");
  // GIVEN a port that no other test has
  const std::string port = "udpm://239.255.76.67:7700?ttl=0";
  const std::string own = runtime::FreshMulticastUrl();
  ASSERT_NE(page.find(port), std::string::npos);
  for (std::size_t at = page.find(port); at != std::string::npos; at = page.find(port, at)) {
    page.replace(at, port.size(), own);
    at += own.size();
  }
  const std::vector<Block> blocks = BlocksOf(page);
  const Outcome outcome = clone.Run(ScriptOf(blocks));
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_GE(ExpectShows(blocks, outcome.out), 50);
  EXPECT_EQ(clone.NewFiles(), "");
}

TEST(DocsTest, NameOnlyFilesThatAreThere) {
  const std::vector<std::filesystem::path> pages = Pages();
  EXPECT_GE(pages.size(), 10U);
  for (const std::filesystem::path& page : pages) {
    const std::string text = Content(page);
    std::size_t links = 0;
    for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
      std::string link = text.substr(at + 2, text.find(')', at) - at - 2);
      if (link.starts_with("https://")) continue;
      link = link.substr(0, link.find('#'));
      EXPECT_TRUE(std::filesystem::exists(page.parent_path() / link)) << page << ": " << link;
      ++links;
    }
    EXPECT_GE(links, 1U) << page;
  }
}

TEST(DocsTest, GrantTheLicenseAndSayHowToCiteAndToContribute) {
  const std::string license = ReadSource("LICENSE");
  EXPECT_TRUE(license.starts_with("BSD 3-Clause License\n")) << license;
  EXPECT_NE(license.find("the Fogline authors"), std::string::npos);
  EXPECT_NE(license.find("3. Neither the name of the copyright holder"), std::string::npos);
  const std::string citation = ReadSource("CITATION.cff");
  for (const char* line :
       {"\ntype: software\n", "\nlicense: BSD-3-Clause\n", "\nreferences:\n",
        "Work-in-Progress: Traded Control Transfer", "\n      - family-names: Sourav\n"}) {
    EXPECT_NE(citation.find(line), std::string::npos) << line;
  }
  EXPECT_NE(ReadSource("CONTRIBUTING.md").find("`tools/test`"), std::string::npos);
}

TEST(ReadmeTest, NamesFoglineSpyForLiveTraffic) {
  EXPECT_NE(ReadSource("README.md").find("`fogline spy`"), std::string::npos);
}

TEST(ReadmeTest, ItsCommandsLeaveNoFileThatGitDoesNotKnow) {
  const Clone clone;
  clone.Must("fogline table scenario/paper.json --logs logs/demo");  // as tools/demo does
  // WHEN a shell executes the README's commands
  const std::string readme = ReadSource("README.md");
  static const std::regex kCommand(
      "`(fogline (run|table|sweep|calibrate|study|report|replay|export) "
      "[^`]*(scenario/|--out |logs/)[^`]*)`");
  std::size_t commands = 0;
  for (std::sregex_iterator at(readme.begin(), readme.end(), kCommand), end; at != end; ++at) {
    std::string command = (*at)[1].str();
    // Some commands take long. With few seeds or steps they write files with the same names, and
    // the test needs only the names.
    if ((*at)[2] == "study" || (*at)[2] == "calibrate") command += " --seeds 1:2";
    if (command.find("--pace") != std::string::npos) command += " --set /steps=20";
    // With --view, the program shows its page until Ctrl-C. So `timeout` sends the signal of Ctrl-C
    // after 20 s. The run is then over, because its 20 steps take 2 s.
    if (command.find("--view") != std::string::npos) {
      command = "timeout --preserve-status --signal=INT 20 " + command;
    }
    // This run waits for a driver that a person starts. Here the test starts it.
    if (command.find("--external driver") != std::string::npos) {
      command = "fogline-driver & " + command + "; wait $!";
    }
    clone.Must(command);
    ++commands;
  }
  EXPECT_GE(commands, 8U);
  // AND a log has the file name that lcm-logger gets in docs/network.md
  const std::string network = ReadSource("docs/network.md");
  std::smatch words;
  ASSERT_TRUE(std::regex_search(network, words, std::regex("\n    lcm-logger ([^ ]*) &")));
  clone.Must("cp logs/paper-1.lcm " + words[1].str());
  // THEN git finds no new files
  EXPECT_EQ(clone.NewFiles(), "");
}

}  // namespace
}  // namespace fogline::test
