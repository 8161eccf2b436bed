// The paper's table, reproduced.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

/// Rows of `fogline table scenario/paper.json` for thresholds 0.2, 0.5, 0.8.
nlohmann::json TableRows(const std::vector<std::string>& more) {
  std::vector<std::string> command{Program("fogline"), "table", "scenario/paper.json", "--json"};
  command.insert(command.end(), more.begin(), more.end());
  const Outcome outcome = RunCommand(command);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false)["rows"];
}

class TableTest : public testing::TestWithParam<const char*> {};

TEST_P(TableTest, MeetsThePublishedOneToAPointWithTheScenariosOwnSeed) {
  const nlohmann::json rows = TableRows({"--transport", GetParam()});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0]["threshold"], 0.2);
  EXPECT_NEAR(rows[0]["si_pct"], 100, 0.005);
  EXPECT_NEAR(rows[0]["rhe_pct"], 100, 0.005);
  EXPECT_EQ(rows[1]["threshold"], 0.5);
  EXPECT_NEAR(rows[1]["si_pct"], 80.79, 1);
  EXPECT_LE(rows[1]["rhe_pct"], 0.3);
  EXPECT_EQ(rows[2]["threshold"], 0.8);
  EXPECT_NEAR(rows[2]["si_pct"], 10.23, 1);
  EXPECT_LE(rows[2]["rhe_pct"], 0.3);
  EXPECT_EQ(rows[1]["published_si_pct"], 80.79);
}

INSTANTIATE_TEST_SUITE_P(Transports, TableTest, testing::Values("direct", "memq", "udpm"),
                         [](const auto& transport) { return std::string(transport.param); });

TEST(TableOverSeedsTest, IsTheSameOnEveryTransportToTheLastDigit) {
  const nlohmann::json direct = TableRows({"--seeds", "3:4"});
  EXPECT_EQ(TableRows({"--seeds", "3:4", "--transport", "memq"}), direct);
}

TEST(TableOverSeedsTest, HasMeansNearThePublishedOne) {
  const nlohmann::json rows = TableRows({"--seeds", "1:40"});
  EXPECT_NEAR(rows[0]["si_pct"], 100, 5);
  EXPECT_NEAR(rows[1]["si_pct"], 80.79, 5);
  EXPECT_NEAR(rows[2]["si_pct"], 10.23, 5);
  for (const nlohmann::json& row : rows) {
    EXPECT_TRUE(row["si_std_pct"].is_number());
    EXPECT_TRUE(row["rhe_std_pct"].is_number());
  }
}

TEST(TableOverSeedsTest, HoldsOverAThousandSeeds) {
  const nlohmann::json rows = TableRows({"--seeds", "1:1000"});
  EXPECT_NEAR(rows[0]["si_pct"], 100, 3);
  EXPECT_NEAR(rows[1]["si_pct"], 80.79, 3);
  EXPECT_NEAR(rows[2]["si_pct"], 10.23, 3);
  EXPECT_NEAR(rows[0]["rhe_pct"], 100, 0.3);
  EXPECT_LE(rows[1]["rhe_pct"], 0.3);
  EXPECT_LE(rows[2]["rhe_pct"], 0.3);
}

}  // namespace
}  // namespace fogline::test
