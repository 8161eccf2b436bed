// Suggests words while a command line is typed in a shell (completion). The shell's script
// (cmake/package/completion) calls `fogline --complete WORD...` with the words of the command line
// up to the cursor. The suggestions come from the definitions of the command line, so they always
// fit the program.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace fogline::cli {

/// The option that asks for suggestions. It is the first word of the command line, and is not in
/// the help text.
inline constexpr const char* kComplete = "--complete";

/// A word that may stand at the cursor. If the word ends with '/' or '=', it is not finished.
struct Suggestion {
  std::string word;
  std::string meaning;
};

struct Completion {
  std::vector<Suggestion> words;
  std::string files;  // pattern of the suggested files, such as "*.json"; "": no files
};

/// The words and files that may replace the word at the cursor.
/// @param words of the command line without the program's name; the last one is the word at the
///     cursor, which may be empty
Completion Complete(const CLI::App& app, const std::vector<std::string>& words);

/// A line "WORD<tab>MEANING" for each suggestion, and a line "@files<tab>PATTERN" for files.
std::string ToText(const Completion& completion);

}  // namespace fogline::cli
