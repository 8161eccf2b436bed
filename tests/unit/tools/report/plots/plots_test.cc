#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/atomic_file.h"
#include "tests/support/command.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/input_errors.h"
#include "tests/unit/tools/report/example_curves.h"
#include "tests/unit/tools/report/example_runs.h"
#include "tools/report/figures.h"
#include "tools/report/plots/gnuplot.h"
#include "tools/report/report.h"

namespace fogline {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class PlotsTest : public ::testing::Test {
 protected:
  test::ScratchFolder folder_;
  const fs::path& dir_ = folder_.path();
};

void WriteFigures(const fs::path& folder, report::FigureFormat format,
                  std::span<const report::ReportRun> runs) {
  fs::create_directories(folder);
  AtomicFiles files;
  report::DrawFigures(folder, format, runs, files);
  files.Finish();
}

void WriteCurveFigures(const fs::path& folder, report::FigureFormat format,
                       const report::ReportCurves& curves) {
  fs::create_directories(folder);
  AtomicFiles files;
  report::DrawCurveFigures(folder, format, curves, files);
  files.Finish();
}

std::string Read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A number of four bytes in PNG's order, most significant first.
std::uint32_t NumberAt(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = at; i < at + 4; ++i) {
    number = (number << 8) | static_cast<unsigned char>(bytes.at(i));
  }
  return number;
}

TEST_F(PlotsTest, WritesAPictureOfPaperSizeForEveryFigure) {
  WriteFigures(dir_ / "figures", report::FigureFormat::kPng, ExampleRuns(60));
  std::size_t number = 0;
  for (const report::Figure& figure : report::Figures()) {
    const fs::path file = dir_ / "figures" / fmt::format("figure-{}-{}.png", ++number, figure.id);
    const std::string picture = Read(file);
    ASSERT_THAT(picture, StartsWith("\x89PNG")) << file;
    EXPECT_EQ(NumberAt(picture, 16), 1600U);
    EXPECT_EQ(NumberAt(picture, 20), 1000U);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_ / "figures"), {}), 6);
}

TEST_F(PlotsTest, WritesThemAsSvgAndPdfTooWithTextThatStaysText) {
  WriteFigures(dir_, report::FigureFormat::kSvg, ExampleRuns(60));
  WriteFigures(dir_, report::FigureFormat::kPdf, ExampleRuns(60));
  WriteCurveFigures(dir_, report::FigureFormat::kSvg, ExampleCurves());
  WriteCurveFigures(dir_, report::FigureFormat::kPdf, ExampleCurves());
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_), {}), 2 * (6 + 2));
  const std::string svg = Read(dir_ / "figure-2-host-gap.svg");
  EXPECT_THAT(svg, StartsWith("<?xml"));
  EXPECT_THAT(svg, AllOf(HasSubstr("viewBox=\"0 0 1600 1000\""), HasSubstr(">Time (s)<"),
                         HasSubstr(">LiDAR<"), HasSubstr(">threshold 0.5<")));
  EXPECT_THAT(Read(dir_ / "figure-a-thresholds.svg"), HasSubstr(">DoC threshold<"));
  for (const char* name : {"figure-2-host-gap.pdf", "figure-a-thresholds.pdf"}) {
    const std::string pdf = Read(dir_ / name);
    EXPECT_THAT(pdf, StartsWith("%PDF-")) << name;
    EXPECT_THAT(pdf, HasSubstr("/MediaBox [ 0 0 576 360 ]")) << name << ": 8 by 5 inches";
  }
}

/// The points of each curve of an SVG picture. Marks, and lines of few points, are left out. In
/// SVG, y grows downwards.
std::vector<std::vector<std::pair<double, double>>> CurvesIn(const std::string& svg) {
  constexpr std::size_t kFewest = 30;
  std::vector<std::vector<std::pair<double, double>>> curves;
  for (std::size_t at = svg.find(" d='"); at != svg.npos; at = svg.find(" d='", at + 1)) {
    std::string path = svg.substr(at + 4, svg.find('\'', at + 4) - at - 4);
    for (char& c : path) c = c == 'M' || c == 'L' || c == ',' ? ' ' : c;
    std::istringstream numbers(path);
    std::vector<std::pair<double, double>> points;
    for (double x = 0, y = 0; numbers >> x >> y;) points.emplace_back(x, y);
    if (points.size() >= kFewest) curves.push_back(std::move(points));
  }
  return curves;
}

TEST_F(PlotsTest, DrawEachCurveOfEachRun) {
  // GIVEN two runs with different distances. In the first run the distances grow, in the second run
  // they shrink
  std::vector<report::ReportRun> runs{ExampleRun({.steps = 60}), ExampleRun({.steps = 60})};
  double sign = 1;
  for (report::ReportRun& run : runs) {
    double grown_m = 0;
    for (metrics::Sample& sample : run.samples) {
      grown_m += sign * 0.01;
      sample.radar_range_m = 36 + grown_m;
      sample.lidar_range_m = 34 + grown_m;
      sample.fused_distance_m = 32 + grown_m;
      sample.host_gap_m = 30 + grown_m;
      sample.host_safe_distance_m = 28 + grown_m;
    }
    sign = -1;
  }
  WriteFigures(dir_, report::FigureFormat::kSvg, runs);
  // THEN the picture has five different curves in each panel
  const auto curves = CurvesIn(Read(dir_ / "figure-2-host-gap.svg"));
  std::set<double> rising;
  std::set<double> falling;
  for (const auto& points : curves) {
    const double begin = points.front().second;
    (points.back().second < begin ? rising : falling).insert(begin);
  }
  EXPECT_EQ(rising.size(), 5U);
  EXPECT_EQ(falling.size(), 5U);
}

TEST_F(PlotsTest, SaysAboveEveryPanelIfTheAxisSpansLessThanAHundredthOfTheValue) {
  // GIVEN cars that keep 20 m/s, so that the axis of speeds has its smallest span, 0.112 m/s
  std::vector<report::ReportRun> runs = ExampleRuns(60);
  for (report::ReportRun& run : runs) {
    for (metrics::Sample& sample : run.samples) {
      sample.preceding_speed_mps = sample.host_speed_mps = sample.follower_speed_mps = 20;
    }
  }
  const std::string note = ">axis spans 0.56 % of the value<";
  const auto notes = [&](const fs::path& picture) {
    const std::string svg = Read(picture);
    std::size_t count = 0;
    for (std::size_t at = svg.find(note); at != svg.npos; at = svg.find(note, at + 1)) ++count;
    return count;
  };
  WriteFigures(dir_ / "four", report::FigureFormat::kSvg, runs);
  EXPECT_EQ(notes(dir_ / "four/figure-1-speeds.svg"), 4U);
  EXPECT_THAT(Read(dir_ / "four/figure-1-speeds.svg"), HasSubstr(">threshold 0.5<"));
  // AND the axis of accelerations has no such note, because this axis contains 0
  EXPECT_THAT(Read(dir_ / "four/figure-5-accelerations.svg"),
              ::testing::Not(HasSubstr("axis spans")));
  WriteFigures(dir_ / "one", report::FigureFormat::kSvg, std::span(runs).first(1));
  EXPECT_EQ(notes(dir_ / "one/figure-1-speeds.svg"), 1U);
}

/// Makes gnuplot use another font everywhere, with letters 1.25 times as large.
class OtherFont {
 public:
  explicit OtherFont(const fs::path& folder) {
    const fs::path file = folder / "fonts.conf";
    std::ofstream(file) << R"(<?xml version="1.0"?>
<fontconfig><dir>/usr/share/fonts</dir>
<match target="pattern">
<edit name="family" mode="assign" binding="strong"><string>DejaVu Sans Mono</string></edit>
<edit name="weight" mode="assign" binding="strong"><const>bold</const></edit></match>
<match target="font"><edit name="pixelsize" mode="assign">
<times><name>pixelsize</name><double>1.25</double></times></edit></match></fontconfig>)";
    setenv("FONTCONFIG_FILE", file.c_str(), 1);
  }
  ~OtherFont() { unsetenv("FONTCONFIG_FILE"); }
  OtherFont(const OtherFont&) = delete;
  OtherFont& operator=(const OtherFont&) = delete;
};

/// The number of pixels that are not white, in a part of a PNG file. `part` is the argument of
/// gnuplot's "every".
std::size_t CountInk(const fs::path& picture, std::string_view part) {
  const fs::path table = picture.parent_path() / "pixels.txt";
  AtomicFile output(table);
  report::RunGnuplot(
      fmt::format("set table\nplot '{}' binary filetype=png every {} with rgbimage\n",
                  picture.string(), part),
      output);
  output.Finish();
  std::ifstream lines(table);
  std::size_t ink = 0;
  std::size_t pixels = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream numbers(line);
    int x = 0, y = 0, red = 0, green = 0, blue = 0;
    numbers >> x >> y >> red >> green >> blue;
    ++pixels;
    if (red != 255 || green != 255 || blue != 255) ++ink;
  }
  EXPECT_GE(pixels, 8000U) << picture;
  return ink;
}

TEST_F(PlotsTest, CutsNoTextOffWhateverTheFont) {
  const OtherFont font(dir_);
  const fs::path figures = dir_ / "figures";
  WriteFigures(figures, report::FigureFormat::kPng, ExampleRuns());
  WriteCurveFigures(figures, report::FigureFormat::kPng, ExampleCurves());
  std::vector<fs::path> pictures;
  for (const auto& entry : fs::directory_iterator(figures)) pictures.push_back(entry.path());
  EXPECT_EQ(pictures.size(), 6U + 2U);
  for (const fs::path& picture : pictures) {
    EXPECT_EQ(CountInk(picture, ":::0::7"), 0U) << picture << ", first rows";
    EXPECT_EQ(CountInk(picture, ":::992::999"), 0U) << picture << ", last rows";
    EXPECT_EQ(CountInk(picture, "::0::7"), 0U) << picture << ", first columns";
    EXPECT_EQ(CountInk(picture, "::1592::1599"), 0U) << picture << ", last columns";
    EXPECT_GT(CountInk(picture, ":::400::407"), 0U) << picture << ", its middle";
  }
}

TEST_F(PlotsTest, GrowsWithTheNumberOfRuns) {
  WriteFigures(dir_, report::FigureFormat::kPng,
               std::vector<report::ReportRun>(9, ExampleRun({.steps = 5})));
  EXPECT_GT(NumberAt(Read(dir_ / "figure-1-speeds.png"), 20), 1000U);
}

TEST_F(PlotsTest, DrawsRunsWithoutValuesToo) {
  report::ReportRun empty;
  report::ReportRun alone = ExampleRun({.steps = 5});
  for (metrics::Sample& sample : alone.samples) {
    sample.follower_gap_m = sample.follower_safe_distance_m =
        std::numeric_limits<double>::quiet_NaN();
  }
  EXPECT_NO_THROW(
      WriteFigures(dir_, report::FigureFormat::kPng, std::vector<report::ReportRun>{empty, alone}));
}

TEST_F(PlotsTest, DrawsTheCurvesInTwoPictures) {
  WriteCurveFigures(dir_ / "figures", report::FigureFormat::kPng, ExampleCurves());
  for (const char* name : {"figure-a-thresholds.png", "figure-b-front.png"}) {
    const std::string picture = Read(dir_ / "figures" / name);
    ASSERT_THAT(picture, StartsWith("\x89PNG")) << name;
    EXPECT_EQ(NumberAt(picture, 16), 1600U);
    EXPECT_EQ(NumberAt(picture, 20), 1000U);
  }
}

TEST_F(PlotsTest, DrawsCurvesWithoutSpreadPublishedValuesOrSiToo) {
  report::ReportCurves curves = ExampleCurves();
  curves.published.clear();
  for (report::ReportCurves::Point& point : curves.points) {
    point.si_pct = {};
    point.rhe_pct = {.count = 1, .mean = 0.0};
  }
  EXPECT_NO_THROW(WriteCurveFigures(dir_, report::FigureFormat::kPng, curves));
  curves.points.resize(1);
  curves.points[0].si_pct = {.count = 1, .mean = 100.0};
  EXPECT_NO_THROW(WriteCurveFigures(dir_, report::FigureFormat::kPng, curves));
}

TEST_F(PlotsTest, TakesTheNameOfARunForNothingButAName) {
  const fs::path trap = dir_ / "trap";
  report::ReportRun run = ExampleRun({.threshold = 0.5, .steps = 20});
  run.name = fmt::format("it's `touch {0}`\n system('touch {0}')", trap.string());
  WriteFigures(dir_, report::FigureFormat::kPng, std::vector<report::ReportRun>{run, run});
  EXPECT_FALSE(fs::exists(trap));
}

TEST_F(PlotsTest, FailsWithTheReasonIfTheFileCannotBeWritten) {
  const fs::path file = dir_ / "occupied";
  std::ofstream(file) << "a file, not a folder";
  AtomicFiles files;
  EXPECT_EQ(test::ErrorOf([&] {
              report::DrawFigures(file, report::FigureFormat::kPng, ExampleRuns(5), files);
            }),
            (file / "figure-1-speeds.png").string() + ": error: cannot write: Not a directory");
}

TEST_F(PlotsTest, FailsIfAPictureDoesNotFitAndKeepsTheOldOnes) {
  WriteFigures(dir_, report::FigureFormat::kPng, ExampleRuns(5));
  const auto pictures = [&] {
    std::map<std::string, std::string> content;
    for (const auto& entry : fs::directory_iterator(dir_)) {
      content[entry.path().filename()] = Read(entry.path());
    }
    return content;
  };
  const auto before = pictures();
  const std::string first = (dir_ / "figure-1-speeds.png").string();
  // GIVEN a limit of the file size; the script for gnuplot is smaller, and the picture is larger
  const test::FileSizeLimit limit(20'000);
  ASSERT_GT(fs::file_size(first), limit.bytes());
  try {
    WriteFigures(dir_, report::FigureFormat::kPng, ExampleRuns(6));
    FAIL() << "the picture fits";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), first + ": cannot write: File too large");
  }
  EXPECT_TRUE(pictures() == before);
}

TEST_F(PlotsTest, FailsWithGnuplotsOwnWordsAndLeavesNoFile) {
  const fs::path file = dir_ / "picture.png";
  try {
    AtomicFile picture(file);
    report::RunGnuplot("set terminal pngcairo\nplot nonsense(x)\n", picture);
    FAIL() << "gnuplot knows nonsense(x)";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith("gnuplot: "), HasSubstr("line 2"),
                                    HasSubstr("undefined function: nonsense")));
  }
  EXPECT_FALSE(fs::exists(file));
}

TEST(GnuplotStringTest, HasNoEndBeforeItsEnd) {
  EXPECT_EQ(report::GnuplotString("it's\n`date`"), "'it''s `date`'");
}

}  // namespace
}  // namespace fogline
