// The claims in docs/findings.md agree with the claims that `fogline study` checks.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/study/study_runs.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

/// A claim that docs/findings.md lists under a finding. Its line looks like this: - policy: "It
/// helps." 12 mm, margin 2 mm
struct ListedClaim {
  std::string finding;  // its number
  std::string part;     // "heading" or "side claims"
  std::string study;
  std::string says;
  std::string difference;
  std::string margin;  // "" if the claim has no margin

  auto Key() const { return std::tuple(finding, part, study, says); }
};

/// The findings of docs/findings.md.
struct FindingsPage {
  std::vector<ListedClaim> claims;
  /// The verdict on a part of a finding. The key names the part, such as "Finding 3, heading".
  std::map<std::string, std::string> verdicts;
};

FindingsPage ReadFindings() {
  static const std::regex kClaim("- (\\w+): \"(.*)\" ([^,\"]+)(?:, margin (.+))?");
  static const std::regex kVerdict("(Heading|Side claims): (.*)");
  FindingsPage page;
  std::istringstream lines(ReadText(SourceDirectory() / "docs/findings.md"));
  std::string number;
  std::string part;
  std::string* verdict = nullptr;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (line.starts_with("## ")) number = line.substr(3, line.find('.') - 3);
    if (std::regex_match(line, match, kVerdict)) {
      part = match[1] == "Heading" ? "heading" : "side claims";
      verdict = &page.verdicts["Finding " + number + ", " + part];
      EXPECT_EQ(*verdict, "") << line;
      *verdict = match[2];
    } else if (line.empty()) {
      verdict = nullptr;
    } else if (verdict != nullptr) {
      *verdict += " " + line;
    }
    if (!line.starts_with("- ")) continue;
    EXPECT_TRUE(std::regex_match(line, match, kClaim)) << line;
    page.claims.push_back({number, part, match[1], match[2], match[3], match[4]});
  }
  return page;
}

/// A number of a claim as text, in the unit in which docs/findings.md shows it, such as "12 mm".
/// @param compared what the claim compares; this text ends with the unit of the number
/// @param like a text with the wanted number of decimals
std::string InUnitOfPage(double value, const std::string& compared, const std::string& like) {
  constexpr double kMillimetre = 1000;
  const std::string unit = compared.substr(compared.rfind('(') + 1);
  const bool is_length = unit == "m)";
  const std::size_t point = like.find('.');
  const std::size_t end = like.find(' ');
  const std::size_t decimals = point < end ? end - point - 1 : 0;
  return fmt::format("{:.{}f} {}", std::abs(value) * (is_length ? kMillimetre : 1), decimals,
                     is_length      ? "mm"
                     : unit == "%)" ? "points of SI"
                                    : unit.substr(0, unit.size() - 1));
}

TEST(FindingsTest, EveryFindingRestsOnClaimsOfItsStudies) {
  const ScratchFolder folder;
  const Outcome made = Study({"all", "--seeds", "1", "--out", folder.path(), "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  std::map<std::pair<std::string, std::string>, nlohmann::json> claims;
  const nlohmann::json said = nlohmann::json::parse(made.out);
  for (const auto& study : said["studies"]) {
    for (const auto& claim : study["claims"]) claims[{study["name"], claim["says"]}] = claim;
  }
  std::map<std::string, std::set<std::string>> parts;
  for (const ListedClaim& listed : ReadFindings().claims) {
    parts[listed.finding].insert(listed.part);
    const auto found = claims.find({listed.study, listed.says});
    ASSERT_TRUE(found != claims.end()) << listed.study << ": " << listed.says;
    // A claim of equality has its margin in the field "expected".
    const std::string expected = found->second["expected"];
    const std::string within = "equal (within ";
    if (!expected.starts_with(within)) {
      EXPECT_EQ(listed.margin, "") << listed.says;
      continue;
    }
    EXPECT_EQ(listed.margin, InUnitOfPage(std::stod(expected.substr(within.size())),
                                          found->second["compared"], listed.margin))
        << listed.says;
  }
  EXPECT_EQ(parts.size(), 10U);
  for (const auto& [finding, of_finding] : parts) EXPECT_EQ(of_finding.size(), 2U) << finding;
}

/// The cells of a row of a Markdown table: | It helps. | fog: traded against none | less |
std::vector<std::string> CellsOf(const std::string& line) {
  const std::string bar = " | ";
  std::vector<std::string> cells;
  for (std::size_t begin = 2; begin < line.size();) {
    const std::size_t end = std::min(line.find(bar, begin), line.size() - 2);
    cells.push_back(line.substr(begin, end - begin));
    begin = end + bar.size();
  }
  return cells;
}

TEST(FindingsTest, EveryListedClaimHasTheDifferenceOfTheStudiesPage) {
  // A row: | It helps. | fog: traded against none, ... (m) | less | −0.0124 [... | holds |
  constexpr std::size_t kCells = 5;
  constexpr std::size_t kCompared = 1;
  constexpr std::size_t kFound = 3;
  const std::string minus = "−";
  std::map<std::string, std::vector<std::string>> claims;
  std::istringstream page(ReadText(SourceDirectory() / "docs/studies/studies.md"));
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| ") || !line.ends_with(" | holds |")) continue;
    const std::vector<std::string> cells = CellsOf(line);
    if (cells.size() != kCells) continue;  // a row of another table
    claims[cells[0]] = cells;
  }
  for (const ListedClaim& listed : ReadFindings().claims) {
    ASSERT_TRUE(claims.contains(listed.says)) << listed.says;
    const std::vector<std::string>& cells = claims[listed.says];
    std::string found = cells[kFound];
    if (found.starts_with(minus)) found.replace(0, minus.size(), "-");
    EXPECT_EQ(listed.difference,
              InUnitOfPage(std::stod(found), cells[kCompared], listed.difference))
        << listed.says;
  }
}

TEST(FindingsTest, EveryFindingSaysInWhichParameterSetsItHolds) {
  const ScratchFolder folder;
  const Outcome made = Study({"ensemble", "--seeds", "1", "--out", folder.path(), "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  const nlohmann::json studies = nlohmann::json::parse(made.out)["studies"];
  std::map<std::string, std::string> said;
  for (const auto& claim : studies[0]["claims"]) {
    const std::string says = claim["says"];
    const std::size_t colon = says.find(": ");
    said[says.substr(0, colon)] = says.substr(colon + 2);
  }
  EXPECT_EQ(said.size(), 2 * 10U) << "a heading and side claims for each finding";
  EXPECT_EQ(ReadFindings().verdicts, said);
}

TEST(FindingsTest, TheComparisonsOnParameterSetsAreThoseOfTheirFinding) {
  const ScratchFolder folder;
  ASSERT_EQ(Study({"ensemble", "--seeds", "1", "--out", folder.path()}).code, 0);
  // A row of ensemble.csv begins like this: 3,heading,policy,"With a false echo ...",set 1,
  static const std::regex kRow("(\\d+),([^,]*),([^,]*),\"(.*)\",set (\\d+),.*");
  std::istringstream csv(ReadText(folder.File("ensemble.csv")));
  std::string line;
  std::getline(csv, line);
  std::map<std::tuple<std::string, std::string, std::string, std::string>, int> examined;
  while (std::getline(csv, line)) {
    std::smatch match;
    ASSERT_TRUE(std::regex_match(line, match, kRow)) << line;
    ++examined[{match[1], match[2], match[3], match[4]}];
  }
  for (const auto& [claim, sets] : examined) EXPECT_EQ(sets, 8) << std::get<3>(claim);
  for (const ListedClaim& listed : ReadFindings().claims) {
    EXPECT_EQ(examined.erase(listed.Key()), 1U) << listed.finding << ": " << listed.says;
  }
  for (const auto& [claim, sets] : examined) ADD_FAILURE() << "not listed: " << std::get<3>(claim);
}

}  // namespace
}  // namespace fogline::test
