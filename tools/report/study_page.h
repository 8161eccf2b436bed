// One self-contained HTML page of studies: what each asked, what it found, in words, figures with
// intervals, and tables. This file draws what it is given and runs nothing.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace fogline {

/// One quantity of a figure. NaN: no value there; an interval may be missing too.
struct StudySeries {
  std::string name;
  std::vector<double> x;  // ascending
  std::vector<double> y;
  std::vector<double> low;  // of the interval around y; empty if there is none
  std::vector<double> high;
  bool shown = true;  // at first; the reader can show and hide any
};

struct StudyFigure {
  std::string id;  // unique on the page, of letters, digits and "-"
  std::string title;
  std::string caption;
  std::string x_label;
  std::string y_label;
  /// Names of the places 0, 1, 2 ... of x: a row for each then, with points and whiskers, and lines
  /// with bands else.
  std::vector<std::string> categories;
  bool log_x = false;
  bool log_y = false;  // such as of times to collision, which go from seconds to half an hour
  /// Values of y above it are marked at the end of the axis, so that they flatten no others.
  double most = std::numeric_limits<double>::infinity();
  std::vector<StudySeries> series;
};

struct StudyTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // the first cell names the row
};

/// What one study has to say. Every text may hold anything; it is escaped.
struct StudySection {
  std::string name;  // such as "policy"
  std::string title;
  std::string question;
  std::vector<std::string> findings;  // a paragraph each
  std::string method;
  std::vector<StudyFigure> figures;
  std::vector<StudyTable> tables;
};

/// The page. @param command how it was made, such as "fogline study all"
std::string MakeStudyPage(const std::string& command, std::span<const StudySection> sections);

/// The same in Markdown, without figures, to be read where HTML is not shown.
std::string MakeStudyText(const std::string& command, std::span<const StudySection> sections);

}  // namespace fogline
