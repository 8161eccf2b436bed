// The one place where programs write to stderr. What cannot be written is dropped: a full disk, a
// terminal that is gone, or a pipe that no process reads neither ends a run nor holds it up.
//
// Results go to stdout with fmt::print, and one that cannot be written is an error.
#pragma once

#include <string_view>

namespace fogline {

/// Prints a line on stderr while a run is under way. It waits for nothing: a line for which a pipe
/// or terminal has no room is dropped, and the next one that finds room says how many were. Control
/// characters other than line feeds are escaped. For any thread.
void Notice(std::string_view line) noexcept;

/// The same for an error or a remark of a verb, which a person must not miss: waits until a pipe or
/// terminal has room, 5 s at most.
void Complain(std::string_view line) noexcept;

/// Prints a text as it is, without a line feed. It waits for nothing, and nothing is said of what
/// is dropped: the next picture of a progress bar replaces this one.
void Draw(std::string_view text) noexcept;

/// Makes sure that descriptors 0 to 2 are taken. To be called first in a program: where it was
/// started without stderr (2>&-), the log would become descriptor 2 otherwise, and what is said
/// would be written into it. Writing to a stdout or stderr that was missing fails.
void TakeStandardDescriptors();

}  // namespace fogline
