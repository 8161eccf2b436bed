#include "services/models/sumo/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace fogline::sumo {
namespace {

[[noreturn]] void Fail(const char* call) {
  throw std::system_error(errno, std::generic_category(), call);
}

}  // namespace

MemoryFile::MemoryFile(const std::vector<std::string>& lines)
    : fd_(memfd_create("fogline-sumo", MFD_CLOEXEC)) {
  if (fd_ < 0) Fail("memfd_create");
  std::string text;
  for (const std::string& line : lines) text.append(line).push_back('\n');
  Write(text);
}

MemoryFile::~MemoryFile() { close(fd_); }

std::string MemoryFile::path() const { return "/proc/self/fd/" + std::to_string(fd_); }

void MemoryFile::Write(std::string_view text) const {
  while (!text.empty()) {
    const ssize_t written = write(fd_, text.data(), text.size());
    if (written < 0) Fail("write");
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace fogline::sumo
