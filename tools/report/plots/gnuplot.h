// Runs gnuplot, and defines the style of the pictures.
#pragma once

#include <string>
#include <string_view>

#include "common/atomic_file.h"
#include "tools/report/report.h"

namespace fogline::report {

/// Runs gnuplot with `script`, and writes its standard output into `picture`. RunGnuplot() does not
/// call picture.Finish(), and uses no shell.
/// @throws std::runtime_error with gnuplot's own message, or when the disk is full; Interrupted
void RunGnuplot(const std::string& script, AtomicFile& picture);

inline constexpr std::string_view kInk = "#1b2127";

inline constexpr double kWidth = 1600;

/// A figure's file name: figure-NAME with the suffix of the format.
std::string FigureFile(FigureFormat format, std::string_view name);

/// Commands for a picture of this format. The picture is kWidth wide. The unit of kWidth is a pixel
/// for PNG and SVG, and 1/200 inch for PDF. The commands also set gnuplot's variable `point_scale`.
/// In this format, point sizes must be multiplied by this variable.
std::string Terminal(FigureFormat format, double height);

/// Commands for axes and grid.
extern const std::string_view kAxes;

/// Edges of a plot in its picture, as shares of the picture's width and height, from the lower left
/// corner.
struct Place {
  double left;
  double right;
  double bottom;
  double top;
};

/// Room for texts around a plot, in the unit of kWidth. The room suffices for a font whose letters
/// are a quarter larger than the letters of the widest common font (DejaVu Sans Mono Bold). gnuplot
/// cuts off text outside the picture, and the available font depends on the machine.
inline constexpr double kRoomLeft = 185;   // for values and the y axis's name
inline constexpr double kRoomBelow = 135;  // for values and the x axis's name
inline constexpr double kRoomRight = 45;   // for half of the last number on the x axis
inline constexpr double kRoomOfKey = 115;  // for a key of three lines, above the plots

/// Commands that set the position of the next plot.
std::string Margins(const Place& place);

/// NameOfX(): commands that put the name of the x axis below the next plot. NameOfY(): commands
/// that put the name of the y axis at the left edge of the picture, at the height `middle` (a share
/// of the picture's height). The positions of both names do not depend on the font.
std::string NameOfX(std::string_view name, double height);
std::string NameOfY(std::string_view name, double middle);

/// The numbers of the two labels that name the axes. "unset label" needs these numbers. They are
/// high, because gnuplot gives lower numbers to other labels.
inline constexpr int kLabelOfX = 1001;
inline constexpr int kLabelOfY = 1002;

/// `text` as a gnuplot string in single quotes. gnuplot expands nothing in such a string. Line
/// breaks and other control characters become spaces.
std::string GnuplotString(std::string_view text);

}  // namespace fogline::report
