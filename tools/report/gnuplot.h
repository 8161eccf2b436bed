// Runs gnuplot, and says how our pictures look.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tools/report/report.h"

namespace fogline {

/// Lets gnuplot run `script`, and makes what it writes to its standard output the file `output`.
/// No shell is involved. If gnuplot fails, there is no file.
/// @throws std::runtime_error with gnuplot's own words
void RunGnuplot(const std::string& script, const std::filesystem::path& output);

inline constexpr std::string_view kInk = "#1b2127";

inline constexpr double kWidth = 1600;

/// A figure's file name: figure-NAME with the suffix of the format.
std::string FigureFile(FigureFormat format, std::string_view name);

/// Commands for a picture of that format, kWidth wide: in pixels of a PNG file, and in what is one
/// 200th of an inch in a PDF file. Sizes of points are multiplied with its `point_scale`.
std::string Terminal(FigureFormat format, double height);

/// Commands for axes and grid.
extern const std::string_view kAxes;

/// Where a plot lies in its picture, in shares of it from its lower left corner.
struct Place {
  double left;
  double right;
  double bottom;
  double top;
};

/// Room that a plot leaves for texts, in units of kWidth. It is enough for a font whose letters are
/// a quarter larger than those of the widest that is common (DejaVu Sans Mono Bold): gnuplot cuts
/// off what lies outside the picture, and which font there is depends on the machine.
inline constexpr double kRoomLeft = 185;   // values and the y axis's name
inline constexpr double kRoomBelow = 135;  // values and the x axis's name
inline constexpr double kRoomRight = 45;   // half of the last value
inline constexpr double kRoomOfKey = 115;  // three lines

/// Commands that put the next plot into a place.
std::string Margins(const Place& place);

/// Commands that name the next plot's axis of x below it, and the axis of y at the left edge of the
/// picture, at the height `middle` (a share). Both have fixed distances, whatever the font.
std::string NameOfX(std::string_view name, double height);
std::string NameOfY(std::string_view name, double middle);

/// Their labels, for "unset label". gnuplot gives other labels lower numbers.
inline constexpr int kLabelOfX = 1001;
inline constexpr int kLabelOfY = 1002;

/// `text` as a gnuplot string in single quotes, in which nothing is expanded; line breaks and other
/// control characters become spaces.
std::string GnuplotString(std::string_view text);

}  // namespace fogline
