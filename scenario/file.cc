#include "scenario/file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include "scenario/wording.h"

namespace fogline {
namespace {

// A folder with more entries is not looked through: a hint is not worth the time.
constexpr std::size_t kMostEntries = 10'000;

std::string LastError() { return "cannot be read: " + std::generic_category().message(errno); }

// The files of a folder, in the order of their names; none if it cannot be listed.
std::vector<std::filesystem::path> FilesOf(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error);
  const std::filesystem::directory_iterator end;
  for (std::size_t entries = 0; !error && entry != end; entry.increment(error)) {
    if (++entries > kMostEntries) return {};
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) files.push_back(entry->path().filename());
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::string DidYouMeanFile(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  // An ending that all have is no likeness: names with the same one are compared without it.
  std::vector<std::string> same;
  std::vector<std::string> other;
  for (const std::filesystem::path& name : FilesOf(folder)) {
    if (name.extension() == file.extension()) {
      same.push_back(name.stem().string());
    } else {
      other.push_back(name.string());
    }
  }
  const auto nearest = [](const std::string& word, const std::vector<std::string>& names) {
    return Nearest(word, std::vector<std::string_view>(names.begin(), names.end()));
  };
  if (const auto stem = nearest(file.stem().string(), same)) {
    return DidYouMean((folder / *stem).string() + file.extension().string());
  }
  const auto name = nearest(file.filename().string(), other);
  return name ? DidYouMean((folder / *name).string()) : "";
}

FileText ReadFile(const std::filesystem::path& file, std::size_t max_bytes) {
  constexpr std::size_t kChunk = std::size_t{1} << 16U;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"),
                                                               &std::fclose);
  if (!stream) {
    const std::string why = LastError();
    return {.text = "", .error = errno == ENOENT ? why + DidYouMeanFile(file) : why};
  }
  std::string text;
  std::array<char, kChunk> chunk;
  while (const std::size_t size = std::fread(chunk.data(), 1, chunk.size(), stream.get())) {
    text.append(chunk.data(), size);
    if (text.size() > max_bytes) {
      return {.text = "", .error = fmt::format("larger than {} bytes", max_bytes)};
    }
  }
  if (std::ferror(stream.get()) != 0) return {.text = "", .error = LastError()};
  return {.text = std::move(text), .error = ""};
}

}  // namespace fogline
