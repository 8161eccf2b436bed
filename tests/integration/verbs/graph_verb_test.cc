// `fogline graph` prints the table of roles and channels, and writes it into pages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "fogline/fingerprint.hpp"
#include "services/graph.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

std::string Hexadecimal(std::int64_t hash) {
  char text[19];
  std::snprintf(text, sizeof(text), "0x%016llx", static_cast<unsigned long long>(hash));
  return text;
}

TEST(GraphVerbTest, PrintsMarkdownUnlessItShallPrintJson) {
  const Outcome plain = RunCommand({Program("fogline"), "graph"});
  const Outcome markdown = RunCommand({Program("fogline"), "graph", "--markdown"});
  EXPECT_EQ(markdown.code, 0) << markdown.err;
  EXPECT_EQ(markdown.out, plain.out);
  EXPECT_EQ(RunCommand({Program("fogline"), "graph", "--markdown", "--json"}).code, 2);
}

TEST(GraphVerbTest, PrintsTheHashesThatARoleInAnotherLanguageNeeds) {
  const Outcome outcome = RunCommand({Program("fogline"), "graph", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto graph = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(graph["type_fingerprint"], Hexadecimal(TypeFingerprint()));
  ASSERT_EQ(graph["channels"].size(), kNumChannels);
  const auto radar = graph["channels"][IndexOf<radar_t>()];
  EXPECT_EQ(radar["type"], "radar_t");
  EXPECT_EQ(radar["type_hash"], Hexadecimal(radar_t::getHash()));
  // The index of a role in this list is its number, which names the sender in a signed message.
  for (std::size_t i = 0; i < kRoles.size(); ++i) {
    EXPECT_EQ(graph["roles"][i]["name"], std::string(kRoles[i].name));
    EXPECT_EQ(static_cast<std::size_t>(kRoles[i].role), i);
  }
}

TEST(GraphVerbTest, ReplacesTheTablesOfPagesAndNothingElse) {
  const ScratchFolder folder;
  const std::string tables = RunCommand({Program("fogline"), "graph"}).out;
  const std::size_t middle = tables.find("\n\n");
  const std::string roles = tables.substr(0, middle + 1);
  const std::string both = folder.File("both.md");
  const std::string one = folder.File("one.md");
  std::ofstream(both) << "# Page\n\n| role | program | does |\n|---|---|---|\n| old | old | old |\n"
                         "| older | older | older |\n\nText | text\n\n"
                         "| channel | type | from | to | what |\n|---|---|---|---|---|";
  std::ofstream(one) << "Before\n| role | program | does |\n| old |\nAfter\n| a | table |\n";
  const std::vector<std::string> command{Program("fogline"), "graph", "--into", both, one};
  for (int times = 0; times < 2; ++times) {
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(Content(both),
              "# Page\n\n" + roles + "\nText | text\n\n" + tables.substr(middle + 2));
    EXPECT_EQ(Content(one), "Before\n" + roles + "After\n| a | table |\n");
  }
}

TEST(GraphVerbTest, RefusesAPageWithoutATableAndKeepsIt) {
  const ScratchFolder folder;
  const std::string page = folder.File("page.md");
  std::ofstream(page) << "| role | program |\n";
  const Outcome outcome = RunCommand({Program("fogline"), "graph", "--into", page});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, page +
                             ": error: no table that begins with \"| role | program | does |\" or "
                             "\"| channel | type | from | to | what |\"\n");
  EXPECT_EQ(Content(page), "| role | program |\n");
  // If one of several pages has no table, none of the pages is changed.
  const std::string good = folder.File("good.md");
  const std::string old = "| role | program | does |\n| a | b | c |\n";
  std::ofstream(good) << old;
  EXPECT_EQ(RunCommand({Program("fogline"), "graph", "--into", good, page}).code, 2);
  EXPECT_EQ(Content(good), old);
}

}  // namespace
}  // namespace fogline::test
