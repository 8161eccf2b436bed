// One self-contained HTML page of studies. Each study has a question, an answer in words, figures
// with intervals, and tables. This file only draws its input. It starts no run.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fogline::report {

/// One quantity of a figure. NaN marks a missing value or a missing end of an interval.
struct StudySeries {
  std::string name;
  std::vector<double> x;  // ascending
  std::vector<double> y;
  std::vector<double> low;  // lower ends of the intervals around y; empty if there are none
  std::vector<double> high;
  bool shown = true;  // whether the page shows the series at first; the reader can change it
};

struct StudyFigure {
  std::string id;  // unique on the page; letters, digits and "-"
  std::string title;
  std::string caption;
  std::string x_label;
  std::string y_label;
  /// Names of the values 0, 1, 2 ... of x. With names, each value gets a row with points and
  /// whiskers. Without names, the figure has lines with bands.
  std::vector<std::string> categories;
  bool log_x = false;
  bool log_y = false;  // set for times to collision: they range from seconds to half an hour
  /// Values of y above this limit are only marked at the end of the axis. Otherwise the smaller
  /// values would look flat.
  double most = std::numeric_limits<double>::infinity();
  std::vector<StudySeries> series;
};

struct StudyTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // the first cell is the name of the row
};

enum class ClaimState {
  kHolds,
  kFails,
  kOpen,  // too few runs to decide
};

/// A statement that supports an answer, and whether the runs confirm the statement.
struct StudyClaim {
  std::string says;
  std::string compared;
  std::string expected;
  std::string found;
  ClaimState state = ClaimState::kOpen;
};
/// The state as "holds", "fails" or "open".
std::string_view Text(ClaimState state);

/// Content of one study. Every text may contain any characters; the library escapes it. The page
/// shows question, answer, claims, first figure and first table. A reader must unfold the other
/// parts.
struct StudySection {
  std::string name;  // such as "policy"
  std::string title;
  std::string question;
  std::string answer;
  std::string would_change;  // what would change the answer
  std::vector<StudyClaim> claims;
  std::string method;
  std::vector<StudyFigure> figures;
  std::vector<StudyTable> tables;
};

/// The whole page. @param command the command that makes the page, such as "fogline study all"
std::string MakeStudyPage(const std::string& command, std::span<const StudySection> sections);

/// The page in Markdown without figures, for programs that do not show HTML. It contains only the
/// first table of each study.
std::string MakeStudyText(const std::string& command, std::span<const StudySection> sections);

}  // namespace fogline::report
