// Checksums of the rows in a sweep's file. "FILE.sums" beside the file has one line for each row.
// With the checksums, a continued sweep and a merge detect a row that has changed since it was
// written, for example because a digit was edited or a power cut has damaged the file. Checksums do
// not protect against deliberate changes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace fogline::sweep {

/// The path "FILE.sums".
std::filesystem::path SumsFile(const std::filesystem::path& csv);

/// The line of a row in FILE.sums: the row's CRC-32 (as in zlib and gzip) in hexadecimal digits,
/// and a line feed.
/// @param row without the line feed
std::string SumLine(std::string_view row);
/// Number of bytes of the result of SumLine().
inline constexpr std::int64_t kSumLineBytes = 9;

/// Whether a file has only checksums of rows. The last line may be incomplete, because a kill or a
/// power cut may leave only a part of it.
bool IsSums(const std::filesystem::path& file);

/// Checks the rows of a file in their order.
class RowChecker {
 public:
  enum class Verdict {
    kSame,
    kOther,  // not the row that was written
    kNoSum,  // this row and all rows after it have no checksum
  };

  explicit RowChecker(const std::filesystem::path& csv);

  /// Whether the sweep file has checksums. If it was copied without "FILE.sums", it has none.
  bool has_sums() const { return has_sums_; }
  Verdict Check(std::string_view row);

 private:
  std::ifstream sums_;
  bool has_sums_;
};

}  // namespace fogline::sweep
