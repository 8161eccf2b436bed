// An added policy and an added measure of conflict take part in every study. Each of them needs
// only one line in its list of names and one row in its table.
#include <algorithm>
#include <map>
#include <span>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "services/decision/conflict/conflict_measures.h"
#include "services/decision/policies/policies.h"
#include "tests/support/find_row.h"
#include "tests/support/input_errors.h"
#include "tools/study/study.h"

namespace fogline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

study::StudyResult Make(std::string_view name) {
  const study::Study* study = study::FindStudy(name);
  return study->run({.scenarios = std::string(FOGLINE_SOURCE_DIR) + "/scenario",
                     .seeds = {1, 2},
                     .jobs = 2,
                     .progress = {}});
}

/// The number of lines with each value of a column.
std::map<std::string, int> Column(const std::string& csv, const std::string& name) {
  std::istringstream lines(csv);
  std::string line;
  int place = -1;
  std::map<std::string, int> values;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; std::getline(cells, cell, ','); ++i) {
      if (place < 0 && cell == name) {
        place = i;
        break;
      }
      if (i == place) ++values[cell];
    }
  }
  return values;
}

TEST(ExtensionTest, AnotherPolicyOfTheTableIsInTheScenarioAndInThePolicyStudy) {
  ASSERT_TRUE(test::FindPolicy("cautious"));
  EXPECT_THAT(ScenarioSchema(), HasSubstr("\"cautious\""));
  const study::StudyResult result = Make("policy");
  const std::map<std::string, int> variants = Column(result.files[0].content, "variant");
  for (const policies::PolicyRow& row : policies::Policies()) {
    EXPECT_TRUE(variants.contains(std::string(row.name))) << row.name;
  }
  ASSERT_TRUE(variants.contains("cautious"));
  EXPECT_EQ(variants.at("cautious"), variants.at("traded")) << "in every case, by every measure";
  // The first table has only some of the policies, so the test leaves it out.
  for (const report::StudyTable& table : std::span(result.section.tables).subspan(1)) {
    EXPECT_TRUE(std::ranges::any_of(table.rows, [](const auto& row) {
      return row[0] == "cautious";
    })) << table.caption;
  }
  EXPECT_THAT(result.section.figures[0].categories, Contains("cautious"));
}

TEST(ExtensionTest, AnotherMeasureOfTheTableIsInTheScenarioAndInTheConflictStudy) {
  ASSERT_NE(test::FindConflictMeasure("relative"), nullptr);
  EXPECT_THAT(ScenarioSchema(), HasSubstr("\"relative\""));
  const study::StudyResult result = Make("conflict");
  const std::map<std::string, int> measures = Column(result.files[0].content, "measure");
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    EXPECT_TRUE(measures.contains(std::string(row.name))) << row.name;
  }
  for (const std::string detector : {"relative", "relative + window", "relative + window + sign"}) {
    ASSERT_TRUE(measures.contains(detector)) << detector;
    EXPECT_EQ(measures.at(detector), measures.at("doc")) << "in every condition";
  }
}

TEST(ExtensionTest, AnotherMeasureOfConflictIsRefusedAsAMeasureOfBlame) {
  const auto error = [](const std::string& choice) {
    return test::ErrorOf([&] { ParseScenario(R"({"version": 1})", "f", {choice}); });
  };
  EXPECT_EQ(error("/arbitrator/measure=relative"), "");
  EXPECT_THAT(error("/arbitrator/blame=relative"),
              HasSubstr("error: /arbitrator/blame: \"relative\" is not one of \"nis\", "));
}

}  // namespace
}  // namespace fogline
