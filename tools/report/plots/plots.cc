// The figures as files for a paper. The panels of a figure share their axes, and the key is above
// the panels.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "tools/report/figures.h"
#include "tools/report/plots/gnuplot.h"
#include "tools/report/report.h"
#include "tools/report/tables.h"

namespace fogline::report {
namespace {

constexpr std::string_view kFog = "#e3e8ed";
constexpr std::string_view kHumanTint = "#a0fbedd0";  // transparency first; 00 is opaque
constexpr std::string_view kHumanLines = "#ebcb8d";
constexpr std::string_view kShortfall = "#a0bd3a29";

struct Span {
  double low;
  double high;
};

/// Positions of the panels. Up to three panels are in one column, more panels are in two columns.
/// The key is above the panels.
class Layout {
 public:
  /// @param named whether there is a line of text above each panel
  Layout(std::size_t panels, bool named)
      : columns_(panels <= 3 ? 1 : 2),
        rows_((panels + columns_ - 1) / columns_),
        above_(named ? kRoomOfKey + kName : kRoomOfKey),
        height_(std::max(kLeastHeight, kLeastHeight * static_cast<double>(rows_) / 3)) {}

  double height() const { return height_; }
  bool IsLeft(std::size_t panel) const { return panel % columns_ == 0; }
  bool IsLowest(std::size_t panel, std::size_t panels) const { return panel + columns_ >= panels; }

  /// Position of a panel.
  Place PlaceOf(std::size_t panel) const {
    const auto column = static_cast<double>(panel % columns_);
    const auto row = static_cast<double>(panel / columns_);
    const double width = (kWidth - kRoomLeft - kRoomRight + kColumnGap) / Columns();
    const double height = (height_ - kRoomBelow - above_ + kRowGap) / static_cast<double>(rows_);
    const double left = kRoomLeft + width * column;
    const double top = height_ - above_ - height * row;
    return {left / kWidth, (left + width - kColumnGap) / kWidth, (top - height + kRowGap) / height_,
            top / height_};
  }

  /// How far the middle of all panels is above the lower edge of the picture, as a share of the
  /// picture's height.
  double Middle() const { return (1 + (kRoomBelow - above_) / height_) / 2; }

  Place PlaceOfKey() const { return {0, 1, 1 - kRoomOfKey / height_, 1}; }

 private:
  static constexpr double kLeastHeight = 1000;  // in the unit of kWidth, like the next three
  static constexpr double kName = 50;
  static constexpr double kRowGap = 75;
  static constexpr double kColumnGap = 64;

  double Columns() const { return static_cast<double>(columns_); }

  std::size_t columns_;
  std::size_t rows_;
  double above_;
  double height_;
};

/// Smallest and largest value of these columns over all runs.
Span SpanOf(std::span<const ReportRun> runs, std::span<const Curve> curves) {
  Span span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const ReportRun& run : runs) {
    for (const Curve& curve : curves) {
      for (const double value : Values(ColumnNamed(curve.column), run.samples)) {
        if (!std::isfinite(value)) continue;
        span.low = std::min(span.low, value);
        span.high = std::max(span.high, value);
      }
    }
  }
  return span.low <= span.high ? span : Span{0, 1};
}

/// `span` with a margin, and at least `least` long.
Span Widened(Span span, double least) {
  constexpr double kHalfWithMargin = 0.56;
  const double middle = (span.low + span.high) / 2;
  const double half = kHalfWithMargin * std::max(span.high - span.low, least);
  return {middle - half, middle + half};
}

/// A note such as "axis spans 0.3 % of the value" if the axis spans less than 1 % of the largest
/// value; otherwise "".
std::string AxisNote(Span values, Span axis) {
  constexpr double kNarrow = 0.01;
  const double largest = std::max(std::abs(values.low), std::abs(values.high));
  const double share = (axis.high - axis.low) / largest;
  return share < kNarrow ? fmt::format("axis spans {:.2g} % of the value", 100 * share) : "";
}

Span TimeSpanOf(std::span<const ReportRun> runs) {
  Span span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const ReportRun& run : runs) {
    if (run.samples.empty()) continue;
    span.low = std::min(span.low, run.samples.front().time_s);
    span.high = std::max(span.high, run.samples.back().time_s);
  }
  return span.low < span.high ? span : Span{0, 1};
}

/// A line without values, because gnuplot refuses an empty block.
std::string NoValues(std::size_t curves) {
  std::string line = "NaN";
  for (std::size_t i = 0; i < curves; ++i) line += " NaN";
  return line + '\n';
}

/// The curves' values as a gnuplot data block: time first, then one column for each curve.
std::string DataBlock(std::size_t number, const ReportRun& run, std::span<const Curve> curves) {
  const std::span<const metrics::Sample> samples = run.samples;
  std::string block = fmt::format("$run{} << EOD\n", number);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    block += fmt::format("{}", samples[i].time_s);
    for (const Curve& curve : curves) {
      const double value = ColumnNamed(curve.column).value(samples, i);
      block += std::isfinite(value) ? fmt::format(" {}", value) : " NaN";
    }
    block += '\n';
  }
  if (samples.empty()) block += NoValues(curves.size());
  return block + "EOD\n";
}

std::string Rectangles(const std::vector<Window>& windows, std::string_view colour,
                       std::string_view fill) {
  std::string commands;
  for (const Window& window : windows) {
    commands += fmt::format(
        "set object rectangle from first {}, graph 0 to first {}, graph 1 behind fillcolor rgb "
        "'{}' fillstyle {} noborder\n",
        window.begin_s, window.end_s, colour, fill);
  }
  return commands;
}

std::string Shades(const ReportRun& run) {
  const std::vector<Window> human = HumanWindows(run.samples);
  return "unset object\n" + Rectangles(FogWindows(run.samples), kFog, "solid") +
         Rectangles(human, kHumanTint, "solid") +
         Rectangles(human, kHumanLines, "transparent pattern 4");
}

/// Line style of a curve: width, dashes, colour.
std::string LineOf(const Curve& curve) {
  return fmt::format("linewidth {} dashtype {} linecolor rgb '{}'",
                     curve.part == Part::kDetail ? 1.0 : 1.5,
                     curve.part == Part::kLimit ? "(8, 4)" : "solid",
                     kPalette[static_cast<std::size_t>(curve.colour)]);
}

std::string_view StyleOf(Hold hold) {
  switch (hold) {
    case Hold::kLinear:
      return "lines";
    case Hold::kSince:
      return "fsteps";
    case Hold::kUntil:
      return "steps";
  }
  return "lines";
}

/// gnuplot's column of a curve in its data block. gnuplot counts from 1, and column 1 is the time.
std::size_t PlaceOf(const Figure& figure, std::string_view column) {
  const auto found = std::ranges::find(figure.curves, column, &Curve::column);
  return static_cast<std::size_t>(found - figure.curves.begin()) + 2;
}

/// The plot command of one panel.
std::string Plot(const Figure& figure, std::size_t number) {
  std::vector<std::string> parts;
  if (const Shade& shade = figure.shade; !shade.below.empty()) {
    parts.push_back(fmt::format(
        "$run{0} using 1:{1}:(${2} > ${1} ? ${2} : ${1}) with filledcurves fillcolor "
        "rgb '{3}' fillstyle solid noborder",
        number, PlaceOf(figure, shade.below), PlaceOf(figure, shade.limit), kShortfall));
  }
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    const Curve& curve = figure.curves[i];
    parts.push_back(fmt::format("$run{} using 1:{} with {} {}", number, i + 2, StyleOf(curve.hold),
                                LineOf(curve)));
  }
  return fmt::format("plot {}\n", fmt::join(parts, ", \\\n     "));
}

/// A plot that shows only the key.
std::string Key(const Figure& figure, const Layout& layout) {
  std::vector<std::string> parts{"NaN notitle"};
  for (const Curve& curve : figure.curves) {
    parts.push_back(
        fmt::format("keyentry with lines {} title {}", LineOf(curve), GnuplotString(curve.label)));
  }
  const auto add_shade = [&](std::string_view colour, std::string_view fill,
                             std::string_view what) {
    parts.push_back(fmt::format("keyentry with boxes fillcolor rgb '{}' fillstyle {} title '{}'",
                                colour, fill, what));
  };
  add_shade(kFog, "solid", "fog");
  add_shade(kHumanLines, "pattern 4", "the human drives");
  if (!figure.shade.below.empty()) add_shade(kShortfall, "solid", figure.shade.meaning);
  return fmt::format(
      "{}unset border\nunset tics\nunset grid\n"
      "set key center center horizontal Left reverse samplen 2 width 1 font ',18'\n"
      "plot {}\n"
      "unset key\n{}",
      Margins(layout.PlaceOfKey()), fmt::join(parts, ", \\\n     "), kAxes);
}

std::string NameOfValues(const Figure& figure) {
  return figure.unit.empty() ? std::string(figure.quantity)
                             : fmt::format("{} ({})", figure.quantity, figure.unit);
}

std::string Heading(FigureFormat format, std::span<const ReportRun> runs, const Layout& layout,
                    Span values) {
  const Span time = TimeSpanOf(runs);
  return Terminal(format, layout.height()) + fmt::format(
                                                 "set style fill solid noborder\n"
                                                 "set xrange [{}:{}]\nset yrange [{}:{}]\n"
                                                 "set multiplot\n",
                                                 time.low, time.high, values.low, values.high);
}

std::string Unset(int label) { return fmt::format("unset label {}\n", label); }

std::string Panel(const Figure& figure, std::span<const ReportRun> runs, std::size_t index,
                  const Layout& layout, const std::string& note) {
  std::string commands = Margins(layout.PlaceOf(index)) + Shades(runs[index]);
  if (!note.empty()) {
    commands += fmt::format(
        "set label 2 {} at graph 1, graph 1 offset 0, 0.7 right font ',15' textcolor rgb '{}'\n",
        GnuplotString(note), kPalette[1]);
  }
  if (runs.size() > 1) {
    commands += fmt::format("set label 1 {} at graph 0, graph 1 offset 0, 0.7 left\n",
                            GnuplotString(RunName(runs, index)));
  }
  const bool left = layout.IsLeft(index);
  const bool lowest = layout.IsLowest(index, runs.size());
  commands +=
      fmt::format("set format x '{}'\nset format y '{}'\n", lowest ? "%h" : "", left ? "%h" : "");
  commands += lowest ? NameOfX("Time (s)", layout.height()) : Unset(kLabelOfX);
  commands += index == 0 ? NameOfY(NameOfValues(figure), layout.Middle()) : Unset(kLabelOfY);
  return commands + Plot(figure, index);
}

std::string Script(const Figure& figure, FigureFormat format, std::span<const ReportRun> runs) {
  const Span values = SpanOf(runs, figure.curves);
  const Span axis = Widened(values, figure.least_span);
  const std::string note = AxisNote(values, axis);
  const Layout layout(runs.size(), runs.size() > 1 || !note.empty());
  std::string script;
  for (std::size_t i = 0; i < runs.size(); ++i) script += DataBlock(i, runs[i], figure.curves);
  script += Heading(format, runs, layout, axis) + Key(figure, layout);
  for (std::size_t i = 0; i < runs.size(); ++i) script += Panel(figure, runs, i, layout, note);
  return script + "unset multiplot\n";
}

}  // namespace

void DrawFigures(const std::filesystem::path& dir, FigureFormat format,
                 std::span<const ReportRun> runs, AtomicFiles& files) {
  if (runs.empty()) return;
  for (std::size_t i = 0; i < Figures().size(); ++i) {
    const Figure& figure = Figures()[i];
    const std::string name = FigureFile(format, fmt::format("{}-{}", i + 1, figure.id));
    RunGnuplot(Script(figure, format, runs), files.Add(dir / name));
  }
}

}  // namespace fogline::report
