// Programs write to stderr only with these functions. Text that cannot be written is dropped. So a
// run continues if the disk is full, the terminal is closed, or a pipe has no reader.
//
// Results go to stdout with fmt::print. A result that cannot be written is an error.
#pragma once

#include <string_view>

namespace fogline {

/// Prints a line on stderr during a run. The call does not wait. If a pipe or terminal has no room,
/// the line is dropped. The next printed line says how many lines are missing. Control characters
/// other than line feeds are escaped. May be called from any thread.
void Notice(std::string_view line) noexcept;

/// Like Notice(), but for an error or a remark that a person must not miss. The call waits until a
/// pipe or terminal has room, 5 s at most.
void Complain(std::string_view line) noexcept;

/// Prints a text unchanged, without a line feed. The call does not wait. Dropped text is not
/// reported, because a progress bar is drawn again soon.
void Draw(std::string_view text) noexcept;

/// Makes sure that descriptors 0 to 2 are open. Call this function first in a program. Without the
/// call, the log of a program that was started without stderr (2>&-) could become descriptor 2.
/// Messages would then be written into the log. The call prevents this: if stdout or stderr was
/// missing, every later write to this descriptor fails.
void TakeStandardDescriptors();

}  // namespace fogline
