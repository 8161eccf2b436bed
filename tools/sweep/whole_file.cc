#include "tools/sweep/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "scenario/loader.h"

namespace fogline {

namespace {

std::filesystem::path PartOf(const std::filesystem::path& file) { return file.string() + ".part"; }

/// Why no file can replace what has this name; "" if one can.
std::string_view Obstacle(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_directory(status)) return "it is a folder";
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return "it is no regular file";
  }
  return "";
}

InputError CannotWrite(const std::filesystem::path& file, std::string_view option,
                       std::string_view why) {
  return InputError(fmt::format("{}: error: {}{}cannot write: {}", file.string(), option,
                                option.empty() ? "" : ": ", why));
}

/// Makes an empty file in a folder and removes it again. Its name is nobody else's: what is there,
/// such as the half of a result that another process writes, stays.
/// @throws InputError that speaks of `result`
void TryFile(const std::filesystem::path& folder, const std::filesystem::path& result,
             std::string_view option) {
  const std::filesystem::path file = folder / fmt::format(".fogline-{}", getpid());
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) throw CannotWrite(result, option, std::strerror(errno));
  close(descriptor);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
}

}  // namespace

WholeFile::WholeFile(std::filesystem::path file) : file_(std::move(file)), part_(PartOf(file_)) {
  if (const std::string_view why = Obstacle(file_); !why.empty()) {
    throw CannotWrite(file_, "", why);
  }
  out_.open(part_, std::ios::binary);
  if (!out_) throw CannotWrite(file_, "", std::strerror(errno));
}

WholeFile::~WholeFile() {
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void WholeFile::Write(std::string_view text) {
  if (!out_.write(text.data(), static_cast<std::streamsize>(text.size()))) Fail();
}

void WholeFile::Close() {
  if (out_.is_open()) out_.close();
  if (!out_) Fail();
}

void WholeFile::Finish() {
  Close();
  if (std::rename(part_.c_str(), file_.c_str()) != 0) Fail();
}

void WholeFile::Fail() const {
  throw std::runtime_error(
      fmt::format("{}: cannot write: {}", file_.string(), std::strerror(errno)));
}

void RequireFolderOf(const std::filesystem::path& file, std::string_view option) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  std::error_code error;
  if (folder == fs::absolute(kDefaultFolder)) fs::create_directory(folder, error);
  if (fs::status(folder, error).type() != fs::file_type::not_found) return;
  throw InputError(fmt::format("{}: error: {}: there is no folder {}", file.string(), option,
                               file.parent_path().string()));
}

void RequireWritable(const std::filesystem::path& file, std::string_view option) {
  if (const std::string_view why = Obstacle(file); !why.empty()) {
    throw CannotWrite(file, option, why);
  }
  RequireFolderOf(file, option);
  TryFile(file.parent_path(), file, option);
}

void RequireWritableFolder(const std::filesystem::path& folder, std::string_view option) {
  // "figures/" is the folder "figures".
  RequireFolderOf(folder.has_filename() ? folder : folder.parent_path(), option);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw CannotWrite(folder, option, error.message());
  TryFile(folder, folder, option);
}

}  // namespace fogline
