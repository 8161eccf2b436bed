// The README says what the code says.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

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
  source.erase(0, source.find("#include"));  // without the comment on top
  EXPECT_NE(ReadSource("services/README.md").find(source), std::string::npos) << source;
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

}  // namespace
}  // namespace fogline::test
