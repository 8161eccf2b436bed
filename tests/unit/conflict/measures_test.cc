// What every row of the table promises.
#include "services/conflict/measures.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/conflict/evidence.h"

namespace fogline {

static void PrintTo(const ConflictMeasureRow& row, std::ostream* out) { *out << row.name; }

namespace {

enum class Sides { kBoth, kLidarShort };

// What a measure claims beside its range. Who claims less than this says so below.
struct Claims {
  Sides sides = Sides::kBoth;  // both: d and -d score the same, and 0 the least
  bool zero_for_equal = true;  // equal evidence scores 0
};

Claims ClaimsOf(std::string_view name) {
  static const std::map<std::string_view, Claims> kLess{
      {"doc", {.zero_for_equal = false}},  // 0.00005
      {"nis_signed", {.sides = Sides::kLidarShort}},
      {"dempster_bins", {.zero_for_equal = false}},  // its known defect
      {"cusum", {.sides = Sides::kLidarShort}},
      {"sprt", {.sides = Sides::kLidarShort, .zero_for_equal = false}},  // below 0
      {"lidar_modes", {.zero_for_equal = false}},                        // a small probability
  };
  const auto less = kLess.find(name);
  return less == kLess.end() ? Claims{} : less->second;
}

class EveryMeasureTest : public testing::TestWithParam<ConflictMeasureRow> {
 protected:
  std::unique_ptr<ConflictMeasure> Make(const ConflictParameters& parameters = {}) const {
    return GetParam().make(parameters);
  }

  // The score after this evidence has been there for `steps`.
  double After(int steps, const Evidence& evidence) const {
    const auto measure = Make();
    double score = 0;
    for (int i = 0; i < steps; ++i) score = measure->Step(evidence);
    return score;
  }

  std::vector<double> ScoresOfAnything(ConflictMeasure& measure) const {
    const Random random(6, Stream::kRadar);
    std::vector<double> scores;
    for (int step = 0; step < 400; ++step) scores.push_back(measure.Step(Anything(random, step)));
    return scores;
  }

  Claims claims() const { return ClaimsOf(GetParam().name); }

  static constexpr int kSteps = 3;           // fewer than any ceiling needs
  static constexpr double kRounding = 1e-7;  // roots of differences of squares
  static constexpr double kBin_m = 0.5;      // bins promise nothing between multiples of it
};

TEST_P(EveryMeasureTest, BeginsAgainAfterReset) {
  const auto measure = Make();
  const std::vector<double> first = ScoresOfAnything(*measure);
  measure->Reset();
  EXPECT_EQ(ScoresOfAnything(*measure), first);
}

TEST_P(EveryMeasureTest, GivesEqualScoresForEqualEvidenceToTheBit) {
  EXPECT_EQ(ScoresOfAnything(*Make()), ScoresOfAnything(*Make()));
}

TEST_P(EveryMeasureTest, StaysInItsRangeWhateverComesUnderEveryRule) {
  for (const auto rule : {MissingLidar::kHold, MissingLidar::kSkip, MissingLidar::kConflict}) {
    ConflictParameters parameters;
    parameters.missing = rule;
    for (const double score : ScoresOfAnything(*Make(parameters))) {
      ASSERT_TRUE(std::isfinite(score));
      ASSERT_TRUE(GetParam().range != "[0, 1]" || score <= 1) << score;
      ASSERT_TRUE(!GetParam().range.starts_with("[0") || score >= 0) << score;
    }
  }
}

TEST_P(EveryMeasureTest, GrowsAsTheLidarGetsShorter) {
  double last = After(kSteps, LidarShortBy(0));
  for (double short_m = kBin_m; short_m <= 8; short_m += kBin_m) {
    const double score = After(kSteps, LidarShortBy(short_m));
    EXPECT_GE(score, last - kRounding) << short_m;
    last = score;
  }
  EXPECT_GT(last, After(kSteps, LidarShortBy(0)));
}

TEST_P(EveryMeasureTest, TellsALidarThatIsLongAsItClaims) {
  for (double error_m = kBin_m; error_m <= 8; error_m += kBin_m) {
    const double longer = After(kSteps, LidarShortBy(-error_m));
    if (claims().sides == Sides::kLidarShort) {
      EXPECT_LE(longer, After(kSteps, LidarShortBy(0))) << error_m;
    } else if (GetParam().name == "lidar_modes") {
      EXPECT_GT(longer, After(kSteps, LidarShortBy(0))) << error_m;  // r* is on one side only
    } else {
      EXPECT_NEAR(longer, After(kSteps, LidarShortBy(error_m)), kRounding) << error_m;
    }
  }
}

TEST_P(EveryMeasureTest, FindsConflictInEqualEvidenceOnlyIfItSaysSo) {
  const double score = After(kSteps, LidarShortBy(0, 0.3, 0.3));
  if (claims().zero_for_equal) {
    EXPECT_NEAR(score, 0, kRounding);
  } else {
    EXPECT_GT(std::abs(score), kRounding);
  }
}

TEST_P(EveryMeasureTest, HoldsWhatItHadWhenAValueIsMissing) {
  if (GetParam().name == "lidar_modes") {
    // It alone takes a missing value for evidence, whatever the rule.
    const auto measure = Make();
    measure->Step(LidarShortBy(0));
    EXPECT_GT(measure->Step(WithoutLidar(LidarShortBy(0))), 0.1);
    return;
  }
  // As if the last evidence had been there again.
  const auto measure = Make();
  measure->Step(LidarShortBy(0.7));
  EXPECT_EQ(measure->Step(WithoutLidar(LidarShortBy(0.7))), After(2, LidarShortBy(0.7)));
}

TEST_P(EveryMeasureTest, RisesWithAMissingValueThatCountsAsConflict) {
  ConflictParameters parameters;
  parameters.missing = MissingLidar::kConflict;
  const auto measure = Make(parameters);
  const double before = measure->Step(LidarShortBy(0));
  double after = before;
  for (int i = 0; i < kSteps; ++i) after = measure->Step(WithoutLidar(LidarShortBy(0)));
  EXPECT_GT(after, before + 0.1);  // unequal precision alone is d_J = 0.7 on consonant beliefs
}

TEST_P(EveryMeasureTest, ScoresASkippedStepNoHigherThanOneThatWasMeasured) {
  ConflictParameters parameters;
  parameters.missing = MissingLidar::kSkip;
  const auto measure = Make(parameters);
  // 0.1 m: evidence that leaves LiDAR modes clean, for which alone no echo is more suspicious.
  const double before = measure->Step(LidarShortBy(0.1));
  const double after = measure->Step(WithoutLidar(LidarShortBy(0.1)));
  EXPECT_EQ(after > before, GetParam().name == "lidar_modes");
}

TEST_P(EveryMeasureTest, IsBlindToTheOffsetThatItWasToldOfUnlikeTheDoc) {
  constexpr double kOffset_m = 0.5;
  ConflictParameters parameters;
  parameters.offset_m = kOffset_m;
  Evidence evidence = LidarShortBy(1);
  evidence.radar.range_m += kOffset_m;
  const double change = Make(parameters)->Step(evidence) - After(1, LidarShortBy(1));
  EXPECT_EQ(std::abs(change) > kRounding, GetParam().name == "doc");
}

INSTANTIATE_TEST_SUITE_P(Of, EveryMeasureTest, testing::ValuesIn(ConflictMeasures()),
                         [](const auto& row) { return std::string(row.param.name); });

template <class Row>
void ExpectWhole(std::span<const Row> rows) {
  std::set<std::string_view> names;
  for (const Row& row : rows) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name << " is there twice";
    EXPECT_FALSE(row.definition.empty() || row.source.empty() || row.range.empty() ||
                 row.missing.empty() || row.make == nullptr)
        << row.name;
  }
}

std::string ReadFile(const std::string& path) {
  std::ifstream file(std::string(FOGLINE_SOURCE_DIR) + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(MeasureTableTest, HasNoNameTwiceAndNoCellEmpty) {
  ExpectWhole(ConflictMeasures());
  ExpectWhole(BlameMeasures());
}

TEST(MeasureTableTest, FindsRowsByName) {
  EXPECT_EQ(FindConflictMeasure("cusum")->name, "cusum");
  EXPECT_EQ(FindBlameMeasure("deng")->name, "deng");
  EXPECT_EQ(FindConflictMeasure("cusun"), nullptr);
  EXPECT_EQ(FindBlameMeasure(""), nullptr);
}

TEST(MeasureTableTest, IsTheTableOfTheReadme) {
  const std::string readme = ReadFile("/services/conflict/README.md");
  const auto expect_row = [&](std::string_view name, std::string_view source) {
    const std::size_t row = readme.find("| `" + std::string(name) + "` |");
    ASSERT_NE(row, std::string::npos) << name;
    const std::string line = readme.substr(row, readme.find('\n', row) - row);
    EXPECT_NE(line.find(source), std::string::npos) << name << ": " << source;
  };
  for (const auto& row : ConflictMeasures()) expect_row(row.name, row.source);
  for (const auto& row : BlameMeasures()) expect_row(row.name, row.source);
}

}  // namespace
}  // namespace fogline
