// The one place where programs write to stderr. Text that cannot be written is dropped: a full
// disk, a closed terminal, or a pipe without a reader neither ends a run nor holds it up.
//
// Results go to stdout with fmt::print. A result that cannot be written is an error.
#pragma once

#include <string_view>

namespace fogline {

/// Prints a line on stderr while a run is under way. It does not wait: if a pipe or terminal has no
/// room, the line is dropped, and the next line that finds room says how many are missing. Control
/// characters other than line feeds are escaped. May be called from any thread.
void Notice(std::string_view line) noexcept;

/// Prints an error, or a remark that a person must not miss, like Notice(), but waits until a pipe
/// or terminal has room, 5 s at most.
void Complain(std::string_view line) noexcept;

/// Prints a text as it is, without a line feed. It does not wait, and dropped text is not reported:
/// the next picture of a progress bar replaces this one.
void Draw(std::string_view text) noexcept;

/// Makes sure that descriptors 0 to 2 are taken. Call it first in a program. Otherwise, if the
/// program was started without stderr (2>&-), its log would become descriptor 2, and messages would
/// be written into it. If stdout or stderr was missing, a write to it fails.
void TakeStandardDescriptors();

}  // namespace fogline
