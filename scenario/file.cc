#include "scenario/file.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <system_error>

#include <fmt/core.h>

namespace fogline {
namespace {

std::string LastError() { return "cannot be read: " + std::generic_category().message(errno); }

}  // namespace

FileText ReadFile(const std::filesystem::path& file, std::size_t max_bytes) {
  constexpr std::size_t kChunk = std::size_t{1} << 16U;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"),
                                                               &std::fclose);
  if (!stream) return {.text = "", .error = LastError()};
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
