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

/// `; did you mean "scenario/paper.json"?` for a name of which there is no file: the one in the
/// same folder that is spelt alike. Nothing if there is none.
std::string DidYouMeanFile(const std::filesystem::path& file);

/// The bytes of a file of at most `max_bytes`. The error of a file that is not there has the name
/// that may be meant.
FileText ReadFile(const std::filesystem::path& file, std::size_t max_bytes);

}  // namespace fogline
