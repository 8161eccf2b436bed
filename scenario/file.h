// Reading a whole file.
#pragma once

#include <filesystem>
#include <string>

namespace fogline {

/// What came of it: `error` is empty, or says why `text` is not there.
struct FileText {
  std::string text;
  std::string error;
};

/// The bytes of a file of at most `max_bytes`.
FileText ReadFile(const std::filesystem::path& file, std::size_t max_bytes);

}  // namespace fogline
