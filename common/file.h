// Reading a whole file, and the error texts of failed calls for files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace fogline {

/// Least number of bytes for one system call. Smaller pieces are collected in a buffer, because a
/// system call takes as long as copying thousands of bytes.
inline constexpr std::size_t kWorthACall = 1 << 16;

/// Result of reading a file: its text or an error. `error` is empty after success.
struct FileText {
  std::string text;
  std::string error;
};

/// Returns a text such as `; did you mean "scenario/paper.json"?` for the name of a file that does
/// not exist. Suggests a file in the same folder with a similar name; "" if there is no such file.
/// @param ending the ending of suggested files, such as ".json"; "" for any ending
std::string DidYouMeanFile(const std::filesystem::path& file, std::string_view ending = "");

/// Reads a file or pipe of at most `max_bytes` bytes. A shell's `<(command)` is such a pipe. A pipe
/// is read up to its end, but reading fails if no process writes into the pipe for 5 s. If the file
/// does not exist, the error suggests a file with the ending `ending`.
/// @throws std::runtime_error as ThrowIfExhausted()
FileText ReadFile(const std::filesystem::path& file, std::size_t max_bytes,
                  std::string_view ending = "");

/// The reason why a program cannot map this file or seek in this file; "" if the file is regular or
/// does not exist.
std::string WhyNoRegularFile(const std::filesystem::path& file);

/// A file that is opened for reading, and closed by the destructor. Opening a pipe does not wait
/// for a writer.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file);
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  /// The descriptor; -1 with errno if the file could not be opened.
  int fd() const { return fd_; }

 private:
  int fd_;
};

/// Writes all bytes to an open file. @return 0, or errno
/// @param stop called while a pipe or terminal has no room; if `stop` returns true, WriteAll()
///     returns EINTR
int WriteAll(int fd, std::string_view bytes, bool (*stop)() = nullptr);

/// Throws if a call failed because no descriptors, no memory or no disk space is left. The run then
/// fails (exit code 3), although the input is good. After any other error, this function returns.
/// @param error errno of the call
/// @param what such as the file's name
/// @throws std::runtime_error "WHAT: Too many open files; ulimit -n 1024 allows more"
void ThrowIfExhausted(int error, std::string_view what);

/// The folder for temporary files: $TMPDIR, or /tmp. @throws InputError if it is no folder
std::filesystem::path TemporaryFolder();

}  // namespace fogline
