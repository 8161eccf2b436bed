// Runs gnuplot, and says how our pictures look.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace fogline {

/// Lets gnuplot run `script`, and makes what it writes to its standard output the file `output`.
/// No shell is involved. If gnuplot fails, there is no file.
/// @throws std::runtime_error with gnuplot's own words
void RunGnuplot(const std::string& script, const std::filesystem::path& output);

inline constexpr std::string_view kInk = "#1b2127";

/// Commands for a PNG file of 1600 pixels width.
std::string PngTerminal(std::size_t height_px);

/// Commands for axes and grid.
extern const std::string_view kPngAxes;

/// `text` as a gnuplot string in single quotes, in which nothing is expanded; line breaks and other
/// control characters become spaces.
std::string GnuplotString(std::string_view text);

}  // namespace fogline
