#include "common/atomic_file.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/text.h"

namespace fogline {

namespace {

namespace fs = std::filesystem;

// Largest number of links that the kernel follows (path_resolution(7)).
constexpr int kMostLinks = 40;

[[noreturn]] void ThrowCannotWrite(const fs::path& file, std::string_view option,
                                   std::string_view why) {
  throw InputError(fmt::format("{}: error: {}{}cannot write: {}", PathText(file), option,
                               option.empty() ? "" : ": ", why));
}

[[noreturn]] void ThrowCannotWrite(const fs::path& file, std::string_view option, int error) {
  ThrowIfExhausted(error, PathText(file));
  ThrowCannotWrite(file, option, std::strerror(error));
}

fs::path FolderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// The name of a temporary file is this text and 32 hexadecimal digits.
constexpr std::string_view kTemporary = ".fogline-";
constexpr std::size_t kRandomDigits = 32;

/// The file to which a name refers after all symbolic links are resolved.
struct Target {
  fs::path path;
  std::optional<int> descriptor;  // set if the name refers to an open descriptor of this process
  fs::file_status status;
};

/// The descriptor to which a name in /proc/self/fd refers; nullopt for any other name. If the file
/// were opened by its name in /proc/self/fd, writes would begin at byte 0, and would overwrite the
/// bytes that were written through the descriptor.
std::optional<int> DescriptorOf(const fs::path& link) {
  std::error_code error;
  const fs::path folder = fs::canonical(FolderOf(link), error);
  if (error || folder != fmt::format("/proc/{}/fd", getpid())) return std::nullopt;
  return std::atoi(link.filename().c_str());
}

Target TargetOf(const fs::path& file) {
  std::error_code ignored;
  fs::path path = file;
  for (int links = 0; links < kMostLinks; ++links) {
    if (!fs::is_symlink(fs::symlink_status(path, ignored))) break;
    if (const auto descriptor = DescriptorOf(path)) {
      return {.path = path, .descriptor = descriptor, .status = fs::status(path, ignored)};
    }
    path = FolderOf(path) / fs::read_symlink(path, ignored);  // operator/ drops the folder if the
                                                              // link is absolute
  }
  return {.path = path, .descriptor = {}, .status = fs::symlink_status(path, ignored)};
}

bool IsStream(const Target& target) {
  return target.descriptor || fs::is_fifo(target.status) || fs::is_character_file(target.status);
}

/// Reason why the file cannot be written; "" if it can be written.
std::string Obstacle(const fs::path& file, const Target& target) {
  if (fs::is_directory(target.status)) return "it is a folder";
  if (IsStream(target)) return "";
  if (fs::is_regular_file(target.status)) {
    // The kernel may forbid following a link that another user has made (protected_symlinks).
    const bool is_link = target.path != file;
    return is_link && access(file.c_str(), W_OK) != 0 ? std::strerror(errno) : "";
  }
  if (fs::exists(target.status)) return "it is no regular file";
  if (target.path == file) return "";
  return fmt::format("it is a link to {}, which does not exist", PathText(target.path));
}

/// A name that no other process has chosen or can predict.
fs::path RandomName(const fs::path& folder) {
  std::array<std::uint64_t, 2> random{};
  if (getrandom(random.data(), sizeof(random), 0) != sizeof(random)) {
    throw std::runtime_error(fmt::format("no random numbers: {}", std::strerror(errno)));
  }
  return folder / fmt::format("{}{:016x}{:016x}", kTemporary, random[0], random[1]);
}

/// Makes a new file with the permissions of the umask. @return a descriptor, or -1 with errno
int MakeNew(const fs::path& file) {
  return open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

/// Checks that the folder accepts a new file: creates an empty file and removes it again. @throws
/// InputError that names `result`
void TryFile(const fs::path& folder, const fs::path& result, std::string_view option) {
  const fs::path file = RandomName(folder);
  const int descriptor = MakeNew(file);
  if (descriptor < 0) ThrowCannotWrite(result, option, errno);
  close(descriptor);
  unlink(file.c_str());
}

/// Opens a pipe or device for writing, or duplicates a descriptor. @return a descriptor, or -1 with
/// errno
int Open(const Target& target) {
  if (target.descriptor) {
    const int flags = fcntl(*target.descriptor, F_GETFL);
    if (flags >= 0 && (flags & O_ACCMODE) == O_RDONLY) {
      errno = EBADF;
      return -1;
    }
    return fcntl(*target.descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  }
  // With O_NONBLOCK, open() fails if no process reads the pipe. Without O_NONBLOCK, open() would
  // wait for a reader.
  const int fd = open(target.path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd >= 0) fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) & ~O_NONBLOCK);
  return fd;
}

}  // namespace

AtomicFile::AtomicFile(fs::path file) : file_(std::move(file)) {
  const Target target = TargetOf(file_);
  if (const std::string why = Obstacle(file_, target); !why.empty()) {
    ThrowCannotWrite(file_, "", why);
  }
  target_ = target.path;
  if (IsStream(target)) device_ = OpenStream(file_, "");
  part_ = RandomName(device_ < 0 ? FolderOf(target_) : TemporaryFolder());
  fd_ = MakeNew(part_);
  if (fd_ < 0) {
    const int error = errno;
    if (device_ >= 0) close(device_);
    ThrowCannotWrite(file_, "", error);
  }
  if (device_ < 0) {
    // The new file gets the permissions of the file that it replaces.
    if (fs::is_regular_file(target.status)) {
      fchmod(fd_, static_cast<mode_t>(target.status.permissions()) & 0777);
    }
    return;
  }
  unlink(part_.c_str());
  part_.clear();
}

AtomicFile::~AtomicFile() {
  if (!part_.empty()) unlink(part_.c_str());
  close(fd_);
  if (device_ >= 0) close(device_);
}

bool AtomicFile::IsTemporary(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.size() == kTemporary.size() + kRandomDigits && name.starts_with(kTemporary) &&
         name.find_first_not_of("0123456789abcdef", kTemporary.size()) == std::string::npos;
}

fs::path AtomicFile::part() const { return fmt::format("/proc/self/fd/{}", fd_); }

void AtomicFile::Write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kWorthACall) Flush();
}

void AtomicFile::Flush() {
  if (const int error = WriteAll(fd_, buffer_); error != 0) Fail(error);
  buffer_.clear();
}

void AtomicFile::Close() {
  Flush();
  if (device_ < 0 && fsync(fd_) != 0) Fail(errno);
}

void AtomicFile::RemoveOld() {
  if (device_ < 0 && unlink(target_.c_str()) != 0 && errno != ENOENT) Fail(errno);
}

void AtomicFile::Finish() {
  Close();
  if (device_ >= 0) return HandOver();
  if (std::rename(part_.c_str(), target_.c_str()) != 0) Fail(errno);
  part_.clear();
}

bool AtomicFile::FinishNew() {
  Close();
  if (link(part_.c_str(), target_.c_str()) == 0) return true;  // ~AtomicFile() unlinks part_
  if (errno == EEXIST) return false;
  if (errno != EPERM && errno != EOPNOTSUPP && errno != ENOSYS) Fail(errno);
  // The file system has no hard links.
  if (renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) != 0) {
    if (errno == EEXIST) return false;
    if (errno != EINVAL && errno != ENOSYS) Fail(errno);
    std::error_code unknown;
    if (fs::status(target_, unknown).type() != fs::file_type::not_found) return false;
    if (std::rename(part_.c_str(), target_.c_str()) != 0) Fail(errno);
  }
  part_.clear();
  return true;
}

void AtomicFile::HandOver() {
  buffer_.resize(kWorthACall);
  for (off_t at = 0;;) {
    const ssize_t size = pread(fd_, buffer_.data(), buffer_.size(), at);
    if (size < 0) Fail(errno);
    if (size == 0) return;
    at += size;
    const std::string_view piece(buffer_.data(), static_cast<std::size_t>(size));
    const int error = WriteAll(device_, piece, WasInterrupted);
    if (error == EINTR) throw Interrupted(fmt::format("interrupted in {}", PathText(file_)));
    if (error != 0) Fail(error);
  }
}

void AtomicFile::Fail(int error) const {
  throw std::runtime_error(
      fmt::format("{}: cannot write: {}", PathText(file_), std::strerror(error)));
}

void AtomicFiles::Finish() {
  for (AtomicFile& file : files_) file.Close();
  if (WasInterrupted()) throw Interrupted("interrupted; no file was written");
  for (AtomicFile& file : files_) {
    if (file.is_stream()) file.Finish();
  }
  for (auto file = files_.rbegin(); file != files_.rend(); ++file) file->RemoveOld();
  for (AtomicFile& file : files_) {
    if (!file.is_stream()) file.Finish();
  }
}

bool IsReplaceable(const fs::path& file) { return !IsStream(TargetOf(file)); }

int OpenStream(const fs::path& file, std::string_view option) {
  const int fd = Open(TargetOf(file));
  if (fd < 0 && errno == ENXIO) ThrowCannotWrite(file, option, "no process reads this pipe");
  if (fd < 0) ThrowCannotWrite(file, option, errno);
  return fd;
}

bool IsStdout(const fs::path& file) {
  struct stat named {};
  struct stat out {};
  return !IsReplaceable(file) && stat(file.c_str(), &named) == 0 &&
         fstat(STDOUT_FILENO, &out) == 0 && named.st_dev == out.st_dev &&
         named.st_ino == out.st_ino;
}

void RequireFolderOf(const fs::path& file, std::string_view option) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  std::error_code error;
  if (folder == fs::absolute(kDefaultFolder)) {
    fs::create_directory(folder, error);
    std::error_code unknown;
    if (error && !fs::exists(folder, unknown)) {
      throw InputError(fmt::format("{}: error: cannot make the folder: {}",
                                   PathText(file.parent_path()), error.message()));
    }
  }
  if (fs::status(folder, error).type() != fs::file_type::not_found) return;
  throw InputError(fmt::format("{}: error: {}: there is no folder {}", PathText(file), option,
                               PathText(file.parent_path())));
}

void RequireWritable(const fs::path& file, std::string_view option) {
  const Target target = TargetOf(file);
  std::error_code error;  // also set if there is no such file
  if (fs::symlink_status(target.path, error).type() == fs::file_type::none) {
    ThrowCannotWrite(file, option, error.value());
  }
  if (const std::string why = Obstacle(file, target); !why.empty()) {
    ThrowCannotWrite(file, option, why);
  }
  if (IsStream(target)) return;  // opening and closing a pipe would end its reader's input
  RequireFolderOf(file, option);
  TryFile(FolderOf(target.path), file, option);
}

OutputFolder::OutputFolder(fs::path folder, std::string_view option) : folder_(std::move(folder)) {
  // "figures/" is the folder "figures".
  RequireFolderOf(folder_.has_filename() ? folder_ : folder_.parent_path(), option);
  std::error_code error;
  is_new_ = fs::create_directory(folder_, error);
  std::error_code ignored;
  if (const fs::file_status there = fs::status(folder_, ignored);
      error && fs::exists(there) && !fs::is_directory(there)) {
    ThrowCannotWrite(folder_, option, "it is a file, not a folder");
  }
  if (error) ThrowCannotWrite(folder_, option, error.value());
  try {
    TryFile(folder_, folder_, option);
  } catch (...) {
    Leave();
    throw;
  }
}

OutputFolder::~OutputFolder() { Leave(); }

void OutputFolder::Leave() const {
  std::error_code not_empty;
  if (is_new_) fs::remove(folder_, not_empty);
}

void RefuseToReplace(const fs::path& file, std::string_view option, bool force,
                     std::string_view kind,
                     const std::function<bool(const fs::path&)>& is_of_kind) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) ThrowCannotWrite(file, option, "it is a folder");
  if (!IsReplaceable(file) || !fs::exists(fs::status(file, ignored))) return;
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: error: {}: the file {}", PathText(file), option, why));
  };
  if (!force) refuse("exists; --force replaces it");
  if (fs::is_empty(file, ignored) || !fs::is_regular_file(file, ignored) || is_of_kind(file)) {
    return;
  }
  refuse(fmt::format("is no {} and is not replaced, even with --force", kind));
}

}  // namespace fogline
