// Properties that every measure of the table must have.
#include "services/decision/conflict/conflict_measures.h"

#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {

namespace {

enum class Sides { kBoth, kLidarShort };

// Properties of a measure apart from its range. ClaimsOf() lists the measures that lack one of
// these properties.
struct Claims {
  Sides sides = Sides::kBoth;  // kBoth: d and -d have equal scores, and 0 has the least score
  bool zero_for_equal = true;  // equal evidence scores 0
};

Claims ClaimsOf(std::string_view name) {
  static const std::map<std::string_view, Claims> kLess{
      {"doc", {.zero_for_equal = false}},  // the score is 0.00005
      {"nis_signed", {.sides = Sides::kLidarShort}},
      {"dempster_bins", {.zero_for_equal = false}},  // Dempster's k is above 0: a known defect
      {"cusum", {.sides = Sides::kLidarShort}},
      {"sprt", {.sides = Sides::kLidarShort, .zero_for_equal = false}},  // the score is below 0
      {"lidar_modes", {.zero_for_equal = false}},                        // a small probability
  };
  const auto less = kLess.find(name);
  return less == kLess.end() ? Claims{} : less->second;
}

constexpr int kSteps = 3;           // too few for a score to reach an upper limit
constexpr double kRounding = 1e-7;  // of the square root of a difference of squares
constexpr double kBin_m = 0.5;      // binned measures need not grow within a bin

// The score after `steps` steps with this evidence.
double After(const conflict::ConflictMeasureRow& row, int steps,
             const conflict::Evidence& evidence) {
  const auto measure = row.make({});
  double score = 0;
  for (int i = 0; i < steps; ++i) score = measure->Step(evidence);
  return score;
}

std::vector<double> ScoresOfAnything(conflict::ConflictMeasure& measure) {
  const Random random(6, Stream::kRadar);
  std::vector<double> scores;
  for (int step = 0; step < 400; ++step) scores.push_back(measure.Step(Anything(random, step)));
  return scores;
}

TEST(EveryMeasureTest, BeginsAgainAfterReset) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    const auto measure = row.make({});
    const std::vector<double> first = ScoresOfAnything(*measure);
    measure->Reset();
    EXPECT_EQ(ScoresOfAnything(*measure), first);
  }
}

TEST(EveryMeasureTest, GivesEqualScoresForEqualEvidenceToTheBit) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    EXPECT_EQ(ScoresOfAnything(*row.make({})), ScoresOfAnything(*row.make({})));
  }
}

TEST(EveryMeasureTest, StaysInItsRangeWhateverComesUnderEveryRule) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    for (const auto rule : {MissingLidar::kHold, MissingLidar::kSkip, MissingLidar::kConflict}) {
      conflict::ConflictParameters parameters;
      parameters.missing = rule;
      for (const double score : ScoresOfAnything(*row.make(parameters))) {
        ASSERT_TRUE(std::isfinite(score));
        ASSERT_TRUE(row.range != "[0, 1]" || score <= 1) << score;
        ASSERT_TRUE(!row.range.starts_with("[0") || score >= 0) << score;
      }
    }
  }
}

TEST(EveryMeasureTest, GrowsAsTheLidarGetsShorter) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    double last = After(row, kSteps, LidarShortBy(0));
    for (double short_m = kBin_m; short_m <= 8; short_m += kBin_m) {
      const double score = After(row, kSteps, LidarShortBy(short_m));
      EXPECT_GE(score, last - kRounding) << short_m;
      last = score;
    }
    EXPECT_GT(last, After(row, kSteps, LidarShortBy(0)));
  }
}

TEST(EveryMeasureTest, TellsALidarThatIsLongAsItClaims) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    for (double error_m = kBin_m; error_m <= 8; error_m += kBin_m) {
      const double longer = After(row, kSteps, LidarShortBy(-error_m));
      if (ClaimsOf(row.name).sides == Sides::kLidarShort) {
        EXPECT_LE(longer, After(row, kSteps, LidarShortBy(0))) << error_m;
      } else if (row.name == "lidar_modes") {
        // The score of lidar_modes rises with errors of both signs. But only an error of one sign
        // brings the LiDAR's range nearer to r*, the distance of the fog's echo. So the scores for
        // the two signs differ.
        EXPECT_GT(longer, After(row, kSteps, LidarShortBy(0))) << error_m;
      } else {
        EXPECT_NEAR(longer, After(row, kSteps, LidarShortBy(error_m)), kRounding) << error_m;
      }
    }
  }
}

TEST(EveryMeasureTest, FindsConflictInEqualEvidenceOnlyIfItSaysSo) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    const double score = After(row, kSteps, LidarShortBy(0, 0.3, 0.3));
    if (ClaimsOf(row.name).zero_for_equal) {
      EXPECT_NEAR(score, 0, kRounding);
    } else {
      EXPECT_GT(std::abs(score), kRounding);
    }
  }
}

TEST(EveryMeasureTest, HoldsWhatItHadWhenAValueIsMissing) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    if (row.name == "lidar_modes") {
      // This measure alone treats a missing value as evidence, whatever the parameter `missing` is.
      const auto measure = row.make({});
      measure->Step(LidarShortBy(0));
      EXPECT_GT(measure->Step(WithoutLidar(LidarShortBy(0))), 0.1);
      continue;
    }
    // The score is the same as if the last evidence had come again.
    const auto measure = row.make({});
    measure->Step(LidarShortBy(0.7));
    EXPECT_EQ(measure->Step(WithoutLidar(LidarShortBy(0.7))), After(row, 2, LidarShortBy(0.7)));
  }
}

TEST(EveryMeasureTest, RisesWithAMissingValueThatCountsAsConflict) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    conflict::ConflictParameters parameters;
    parameters.missing = MissingLidar::kConflict;
    const auto measure = row.make(parameters);
    const double before = measure->Step(LidarShortBy(0));
    double after = before;
    for (int i = 0; i < kSteps; ++i) after = measure->Step(WithoutLidar(LidarShortBy(0)));
    // The demanded rise is only 0.1, because the score of `jousselme_consonant` cannot rise much
    // more. This score is at most 0.8, and unequal precision of the sensors alone already makes it
    // 0.7.
    EXPECT_GT(after, before + 0.1);
  }
}

TEST(EveryMeasureTest, ScoresASkippedStepNoHigherThanOneThatWasMeasured) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    conflict::ConflictParameters parameters;
    parameters.missing = MissingLidar::kSkip;
    const auto measure = row.make(parameters);
    // Only lidar_modes gives a missing echo a higher score than a LiDAR range that is 0.1 m too
    // short.
    const double before = measure->Step(LidarShortBy(0.1));
    const double after = measure->Step(WithoutLidar(LidarShortBy(0.1)));
    EXPECT_EQ(after > before, row.name == "lidar_modes");
  }
}

TEST(EveryMeasureTest, IsBlindToTheOffsetThatItWasToldOfUnlikeTheDoc) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    SCOPED_TRACE(row.name);
    constexpr double kOffset_m = 0.5;
    conflict::ConflictParameters parameters;
    parameters.offset_m = kOffset_m;
    conflict::Evidence evidence = LidarShortBy(1);
    evidence.radar.range_m += kOffset_m;
    const double change = row.make(parameters)->Step(evidence) - After(row, 1, LidarShortBy(1));
    EXPECT_EQ(std::abs(change) > kRounding, row.name == "doc");
  }
}

template <class Row>
void ExpectWhole(std::span<const Row> rows) {
  std::set<std::string_view> names;
  for (const Row& row : rows) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name << " is there twice";
    EXPECT_FALSE(row.source.empty() || row.range.empty() || row.missing.empty() ||
                 row.make == nullptr)
        << row.name;
  }
}

using test::Content;
using test::SourceDirectory;

TEST(MeasureTableTest, HasNoNameTwiceAndNoCellEmpty) {
  ExpectWhole(conflict::ConflictMeasures());
  ExpectWhole(conflict::BlameMeasures());
}

TEST(MeasureTableTest, IsTheTableOfTheReadme) {
  const std::string readme = Content(SourceDirectory() / "services/decision/conflict/README.md");
  const auto expect_row = [&](std::string_view name, std::string_view source) {
    const std::size_t row = readme.find("| `" + std::string(name) + "` |");
    ASSERT_NE(row, std::string::npos) << name;
    const std::string line = readme.substr(row, readme.find('\n', row) - row);
    EXPECT_NE(line.find(source), std::string::npos) << name << ": " << source;
  };
  for (const auto& row : conflict::ConflictMeasures()) expect_row(row.name, row.source);
  for (const auto& row : conflict::BlameMeasures()) expect_row(row.name, row.source);
}

}  // namespace
}  // namespace fogline
