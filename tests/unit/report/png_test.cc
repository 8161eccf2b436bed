#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/unit/report/example_curves.h"
#include "tests/unit/report/example_runs.h"
#include "tools/report/figures.h"
#include "tools/report/gnuplot.h"
#include "tools/report/report.h"

namespace fogline {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class PngTest : public ::testing::Test {
 protected:
  test::ScratchFolder folder_;
  const fs::path& dir_ = folder_.path();
};

std::string Read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A number of four bytes, most significant first, as PNG has them.
std::uint32_t NumberAt(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = at; i < at + 4; ++i) {
    number = (number << 8) | static_cast<unsigned char>(bytes.at(i));
  }
  return number;
}

TEST_F(PngTest, WritesAPictureOfPaperSizeForEveryFigure) {
  WritePngFigures(dir_ / "figures", ExampleRuns(60));
  std::size_t number = 0;
  for (const Figure& figure : Figures()) {
    const fs::path file = dir_ / "figures" / fmt::format("figure-{}-{}.png", ++number, figure.id);
    const std::string picture = Read(file);
    ASSERT_THAT(picture, StartsWith("\x89PNG")) << file;
    EXPECT_EQ(NumberAt(picture, 16), 1600U);
    EXPECT_EQ(NumberAt(picture, 20), 1000U);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_ / "figures"), {}), 6);
}

TEST_F(PngTest, GrowsWithTheNumberOfRuns) {
  WritePngFigures(dir_, std::vector<ReportRun>(9, ExampleRun({.steps = 5})));
  EXPECT_GT(NumberAt(Read(dir_ / "figure-1-speeds.png"), 20), 1000U);
}

TEST_F(PngTest, DrawsRunsWithoutValuesToo) {
  ReportRun empty;
  ReportRun alone = ExampleRun({.steps = 5});
  for (Sample& sample : alone.samples) {
    sample.follower_gap_m = sample.follower_safe_distance_m =
        std::numeric_limits<double>::quiet_NaN();
  }
  EXPECT_NO_THROW(WritePngFigures(dir_, std::vector<ReportRun>{empty, alone}));
}

TEST_F(PngTest, DrawsTheCurvesInTwoPictures) {
  WritePngCurves(dir_ / "figures", ExampleCurves());
  for (const char* name : {"figure-a-thresholds.png", "figure-b-front.png"}) {
    const std::string picture = Read(dir_ / "figures" / name);
    ASSERT_THAT(picture, StartsWith("\x89PNG")) << name;
    EXPECT_EQ(NumberAt(picture, 16), 1600U);
    EXPECT_EQ(NumberAt(picture, 20), 1000U);
  }
}

TEST_F(PngTest, DrawsCurvesWithoutSpreadPublishedValuesOrSiToo) {
  ReportCurves curves = ExampleCurves();
  curves.published.clear();
  for (ReportCurves::Point& point : curves.points) {
    point.si_pct = {};
    point.rhe_pct = {.count = 1, .mean = 0.0};
  }
  EXPECT_NO_THROW(WritePngCurves(dir_, curves));
  curves.points.resize(1);
  curves.points[0].si_pct = {.count = 1, .mean = 100.0};
  EXPECT_NO_THROW(WritePngCurves(dir_, curves));
}

TEST_F(PngTest, TakesTheNameOfARunForNothingButAName) {
  const fs::path trap = dir_ / "trap";
  ReportRun run = ExampleRun({.threshold = 0.5, .steps = 20});
  run.name = fmt::format("it's `touch {0}`\n system('touch {0}')", trap.string());
  WritePngFigures(dir_, std::vector<ReportRun>{run, run});
  EXPECT_FALSE(fs::exists(trap));
}

TEST_F(PngTest, FailsWithTheReasonIfTheFileCannotBeWritten) {
  const fs::path file = dir_ / "occupied";
  std::ofstream(file) << "a file, not a folder";
  EXPECT_THROW(WritePngFigures(file, ExampleRuns(5)), std::runtime_error);
}

TEST_F(PngTest, FailsWithGnuplotsOwnWordsAndLeavesNoFile) {
  const fs::path file = dir_ / "picture.png";
  try {
    RunGnuplot("set terminal pngcairo\nplot nonsense(x)\n", file);
    FAIL() << "gnuplot knows nonsense(x)";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith("gnuplot: "), HasSubstr("line 2"),
                                    HasSubstr("undefined function: nonsense")));
  }
  EXPECT_FALSE(fs::exists(file));
}

TEST(GnuplotStringTest, HasNoEndBeforeItsEnd) {
  EXPECT_EQ(GnuplotString("it's\n`date`"), "'it''s `date`'");
}

}  // namespace
}  // namespace fogline
