#include "common/file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"

namespace fogline {
namespace {

// A folder with more entries gets no suggestion, because the search would take too long.
constexpr std::size_t kMostEntries = 10'000;

// Longest wait for data from a pipe. A command on another machine, as in <(ssh HOST COMMAND),
// usually begins to answer within this time.
constexpr int kPipeLimit_ms = 5000;

// While a pipe has no room, WriteAll() calls `stop` at this interval. A person does not notice a
// delay of this length.
constexpr int kRoomPause_ms = 100;

std::string Message(int error) { return std::generic_category().message(error); }

FileText Unreadable(const std::string& why) {
  return {.text = "", .error = "cannot be read: " + why};
}

// The reason why ReadFile() does not read this type of file; "" for a regular file or a pipe.
std::string WhyNotRead(mode_t mode) {
  if (S_ISDIR(mode)) return "it is a folder";
  return S_ISREG(mode) || S_ISFIFO(mode) ? "" : "it is neither a file nor a pipe";
}

// Waits until a pipe has data or is at its end. Returns false if the wait takes longer than
// kPipeLimit_ms.
bool HasMore(int fd) {
  pollfd waited{.fd = fd, .events = POLLIN, .revents = 0};
  int ready = 0;
  do {
    ready = poll(&waited, 1, kPipeLimit_ms);
  } while (ready < 0 && errno == EINTR);
  return ready > 0;
}

// Waits for kRoomPause_ms at most until a pipe or terminal has room. @return false if there is no
// room
bool HasRoom(int fd) {
  pollfd waited{.fd = fd, .events = POLLOUT, .revents = 0};
  const int ready = poll(&waited, 1, kRoomPause_ms);
  return ready > 0 || (ready < 0 && errno != EINTR);  // write() reports the error
}

// The names of the files of a folder, sorted; empty if the folder cannot be listed or has more than
// kMostEntries entries.
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

std::string DidYouMeanFile(const std::filesystem::path& file, std::string_view ending) {
  const std::filesystem::path folder = file.parent_path();
  // Names with the same ending are compared without this ending, because a common ending makes all
  // names similar.
  std::vector<std::string> same;
  std::vector<std::string> other;
  for (const std::filesystem::path& name : FilesOf(folder)) {
    if (!name.native().ends_with(ending)) continue;
    if (name.extension() == file.extension() || (file.extension().empty() && !ending.empty())) {
      same.push_back(name.stem().string());
    } else {
      other.push_back(name.string());
    }
  }
  const auto nearest = [](const std::string& word, const std::vector<std::string>& names) {
    return Nearest(word, std::vector<std::string_view>(names.begin(), names.end()));
  };
  if (const auto stem = nearest(file.stem().string(), same)) {
    const std::string with =
        file.extension().empty() ? std::string(ending) : file.extension().string();
    return DidYouMean((folder / *stem).string() + with);
  }
  const auto name = nearest(file.filename().string(), other);
  return name ? DidYouMean((folder / *name).string()) : "";
}

OpenFile::OpenFile(const std::filesystem::path& file)
    : fd_(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {}

OpenFile::~OpenFile() {
  if (fd_ >= 0) close(fd_);
}

FileText ReadFile(const std::filesystem::path& file, std::size_t max_bytes,
                  std::string_view ending) {
  const OpenFile opened(file);
  if (opened.fd() < 0) {
    const int error = errno;
    ThrowIfExhausted(error, PathText(file));
    return Unreadable(Message(error) + (error == ENOENT ? DidYouMeanFile(file, ending) : ""));
  }
  struct stat info {};
  if (fstat(opened.fd(), &info) != 0) return Unreadable(Message(errno));
  if (const std::string why = WhyNotRead(info.st_mode); !why.empty()) return Unreadable(why);
  std::string text;
  std::array<char, std::size_t{1} << 16U> chunk;
  while (true) {
    if (S_ISFIFO(info.st_mode) && !HasMore(opened.fd())) {
      return Unreadable(
          fmt::format("no process has written into this pipe for {} s", kPipeLimit_ms / 1000));
    }
    const ssize_t size = read(opened.fd(), chunk.data(), chunk.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size < 0) return Unreadable(Message(errno));
    if (size == 0) return {.text = std::move(text), .error = ""};
    text.append(chunk.data(), static_cast<std::size_t>(size));
    if (text.size() > max_bytes) {
      return {.text = "", .error = fmt::format("larger than {} bytes", max_bytes)};
    }
  }
}

std::string WhyNoRegularFile(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return "";
  return std::filesystem::is_directory(status) ? "it is a folder" : "it is no regular file";
}

int WriteAll(int fd, std::string_view bytes, bool (*stop)()) {
  // `stop` tells whether a signal such as SIGINT has come. This signal may arrive in another
  // thread, and then it does not interrupt a write() that waits. So with `stop`, WriteAll() first
  // waits for room. Then each write() gets at most PIPE_BUF bytes. There is room for these bytes,
  // so write() does not wait.
  const std::size_t most = stop == nullptr ? bytes.size() : PIPE_BUF;
  while (!bytes.empty()) {
    if (stop != nullptr && !HasRoom(fd)) {
      if (stop()) return EINTR;
      continue;
    }
    const ssize_t size = write(fd, bytes.data(), std::min(bytes.size(), most));
    if (size < 0 && errno != EINTR) return errno;
    if (size > 0) bytes.remove_prefix(static_cast<std::size_t>(size));
  }
  return 0;
}

void ThrowIfExhausted(int error, std::string_view what) {
  constexpr std::array kExhausted{EMFILE, ENFILE, ENOMEM, ENOSPC, EDQUOT};
  if (std::ranges::find(kExhausted, error) == kExhausted.end()) return;
  throw std::runtime_error(fmt::format("{}: {}{}", what, Message(error),
                                       error == EMFILE ? "; ulimit -n 1024 allows more" : ""));
}

std::filesystem::path TemporaryFolder() {
  std::error_code failed;
  std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
  if (!failed) return folder;
  const char* set = std::getenv("TMPDIR");
  throw InputError(fmt::format("TMPDIR={}: error: no folder for temporary files: {}",
                               set == nullptr ? "" : set, failed.message()));
}

}  // namespace fogline
