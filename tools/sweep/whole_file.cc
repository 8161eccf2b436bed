#include "tools/sweep/whole_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "scenario/loader.h"

namespace fogline {

WholeFile::WholeFile(std::filesystem::path file)
    : file_(std::move(file)), part_(file_.string() + ".part"), out_(part_, std::ios::binary) {
  if (!out_) {
    throw InputError(
        fmt::format("{}: error: cannot write: {}", file_.string(), std::strerror(errno)));
  }
}

WholeFile::~WholeFile() {
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void WholeFile::Write(std::string_view text) {
  if (!out_.write(text.data(), static_cast<std::streamsize>(text.size()))) Fail();
}

void WholeFile::Finish() {
  out_.close();
  if (!out_ || std::rename(part_.c_str(), file_.c_str()) != 0) Fail();
}

void WholeFile::Fail() const {
  throw std::runtime_error(
      fmt::format("{}: cannot write: {}", file_.string(), std::strerror(errno)));
}

void MakeFolderOf(const std::filesystem::path& file) {
  if (!file.has_parent_path()) return;
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) {
    throw InputError(
        fmt::format("{}: error: cannot make the folder: {}", file.string(), error.message()));
  }
}

}  // namespace fogline
