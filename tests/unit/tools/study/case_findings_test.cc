#include "tools/study/case_findings.h"

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include "tools/study/study_findings.h"

namespace fogline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kSeeds = 20;
constexpr double kWholeRun = 500;  // steps

/// A comparison of runs that are equal except for the values that a test sets.
class Runs {
 public:
  Runs(std::vector<study::StudyCase> cases, std::vector<study::StudyVariant> variants)
      : cases_(std::move(cases)), variants_(std::move(variants)) {
    values_.assign(cases_.size() * variants_.size() * study::ComparedMetrics().size() * kSeeds,
                   0.0);
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      for (std::size_t v = 0; v < variants_.size(); ++v) {
        Set({c, v}, "steps", [](std::int64_t) { return kWholeRun; });
      }
    }
  }

  template <class ValueOf>
  void Set(study::Cell cell, std::string_view measure, ValueOf value_of) {
    const std::size_t place = cell.test_case * variants_.size() + cell.variant;
    const std::size_t row = place * study::ComparedMetrics().size() + study::PlaceOfMetric(measure);
    for (std::int64_t i = 0; i < kSeeds; ++i) {
      values_[row * kSeeds + static_cast<std::size_t>(i)] = value_of(i);
    }
  }
  /// Sets the mean compromised safety in fog, a little different for each seed.
  void Compromise(study::Cell cell, double mean_m) {
    Set(cell, "mean_compromised_safety_fog_m",
        [&](std::int64_t seed) { return mean_m + 0.001 * static_cast<double>(seed % 3); });
  }
  void Crash(study::Cell cell, std::int64_t runs) {
    Set(cell, "collided", [&](std::int64_t seed) { return seed < runs ? 1.0 : 0.0; });
    Set(cell, "steps", [&](std::int64_t seed) { return seed < runs ? 100.0 : kWholeRun; });
  }

  study::Comparison Result() const { return {cases_, variants_, kSeeds, values_}; }

 private:
  std::vector<study::StudyCase> cases_;
  std::vector<study::StudyVariant> variants_;
  std::vector<double> values_;
};

Runs OneCase() {
  return {{{.name = "ice", .file = "", .overrides = {}, .group = ""}},
          {{"none", {}}, {"traded", {}}}};
}

TEST(CaseFindingsTest, DoNotCallARunSafeThatCrashesBeforeItsSafetyIsCompromised) {
  Runs runs = OneCase();
  runs.Compromise({0, 0}, 0.10);
  runs.Compromise({0, 1}, 0.07);  // less, because the run ends early
  runs.Crash({0, 1}, kSeeds);
  const study::Comparison comparison = runs.Result();
  EXPECT_EQ(study::VerdictOfCase(comparison, 0, 1, 0), study::CaseVerdict::kCollidesMore);
  const std::vector<std::string> findings = study::CaseFindings(comparison, 1);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_THAT(findings[0], HasSubstr("It collides more in: ice (20 of 20 runs instead of 0)."));
  EXPECT_THAT(findings[0], Not(HasSubstr("It reduces compromised safety in")));
  EXPECT_THAT(findings[1], HasSubstr("the runs of 20 of 20 seeds end early"));
  EXPECT_THAT(findings[1], Not(HasSubstr("SI 0")));
}

TEST(CaseFindingsTest, GiveNoVerdictOnSafetyWhereAFewRunsEndEarly) {
  Runs runs = OneCase();
  runs.Compromise({0, 0}, 0.10);
  runs.Compromise({0, 1}, 0.07);
  runs.Crash({0, 1}, 5);  // five pairs differ, all in one direction: no proof yet, p = 2 / 2^5
  EXPECT_EQ(study::VerdictOfCase(runs.Result(), 0, 1, 0), study::CaseVerdict::kCutShort);
  runs.Crash({0, 1}, 6);
  EXPECT_EQ(study::VerdictOfCase(runs.Result(), 0, 1, 0), study::CaseVerdict::kCollidesMore);
  runs.Crash({0, 0}, 12);
  EXPECT_EQ(study::VerdictOfCase(runs.Result(), 0, 1, 0), study::CaseVerdict::kCollidesLess);
}

TEST(CaseFindingsTest, JudgeByCompromisedSafetyWhereEveryRunLasts) {
  Runs runs = OneCase();
  EXPECT_EQ(study::VerdictOfCase(runs.Result(), 0, 1, 0), study::CaseVerdict::kNothing);
  runs.Compromise({0, 0}, 0.10);
  runs.Set({0, 1}, "mean_compromised_safety_fog_m",
           [](std::int64_t seed) { return 0.07 + 0.001 * static_cast<double>(seed % 5); });
  EXPECT_EQ(study::VerdictOfCase(runs.Result(), 0, 1, 0), study::CaseVerdict::kReduces);
}

TEST(CaseFindingsTest, CountACaseOnceThatIsThereTwice) {
  Runs runs({{.name = "a", .file = "", .overrides = {}, .group = ""},
             {.name = "b", .file = "", .overrides = {}, .group = ""},
             {.name = "c", .file = "", .overrides = {}, .group = ""}},
            {{"none", {}}, {"traded", {}}});
  for (const std::size_t c : {0U, 1U, 2U}) {
    runs.Compromise({c, 0}, 0.10);
    runs.Set({c, 1}, "mean_compromised_safety_fog_m", [&](std::int64_t seed) {
      return (c == 2 ? 0.08 : 0.07) + 0.001 * static_cast<double>(seed % 5);
    });
  }
  const std::vector<std::string> findings = study::CaseFindings(runs.Result(), 1);
  EXPECT_THAT(findings[0], HasSubstr("in 2 counted cases"));
  EXPECT_THAT(findings[0], HasSubstr("It reduces compromised safety in: a and c."));
  EXPECT_THAT(findings[0], HasSubstr("(in brackets): b (a)."));
  EXPECT_EQ(findings[2], "b: the same runs as a.");
}

TEST(SameRunsTest, AreRankedOnceWhateverIsMissing) {
  Runs runs({{.name = "fog", .file = "", .overrides = {}, .group = ""}},
            {{"none", {}}, {"traded", {}}, {"blend", {}}, {"bayes", {}}});
  for (const std::size_t v : {1U, 2U, 3U}) {
    runs.Compromise({0, v}, 0.07);
    runs.Set({0, v}, "min_follower_ttc_s",
             [](std::int64_t) { return std::numeric_limits<double>::quiet_NaN(); });
  }
  runs.Set({0, 3}, "rhe_pct", [](std::int64_t seed) { return seed == 7 ? 1.0 : 0.0; });
  const study::Comparison comparison = runs.Result();
  EXPECT_EQ(study::Distinct(comparison, 0, study::AllVariants(comparison)),
            (std::vector<std::size_t>{0, 1, 3}));
  EXPECT_THAT(study::SameRunsText(comparison, 0), HasSubstr("Blend has the same runs as traded"));
  EXPECT_THAT(study::RankingText(comparison, 0, "rhe_pct", 1, study::Better::kLess),
              Not(HasSubstr("blend")));
}

TEST(AgainstTextTest, SaysHowMuchLessWithoutASign) {
  Runs runs = OneCase();
  runs.Set({0, 0}, "rhe_pct", [](std::int64_t seed) { return seed % 2 == 0 ? 3.9 : 4.1; });
  runs.Set({0, 1}, "rhe_pct", [](std::int64_t) { return 1.0; });
  EXPECT_EQ(study::AgainstText(runs.Result(), 0, {0, 1}, 0, "rhe_pct", "points", 0),
            "less for traded (by 3 [3, 3] points)");
}

}  // namespace
}  // namespace fogline
