#include "tests/fuzz/fuzz.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <fmt/core.h>

#include "common/text.h"

namespace fogline::fuzz {
namespace {

long taken = 0;

}  // namespace

void Demand(bool holds, const char* what) {
  if (holds) return;
  fmt::print(stderr, "does not hold: {}\n", what);
  std::abort();
}

void Took() { ++taken; }
long Taken() { return taken; }

MemoryFile::MemoryFile(runtime::Bytes content) : fd_(memfd_create("fuzz", MFD_CLOEXEC)) {
  Demand(fd_ >= 0 &&
             write(fd_, content.data(), content.size()) == static_cast<ssize_t>(content.size()),
         "a file in memory can be made");
}
MemoryFile::~MemoryFile() { close(fd_); }

std::filesystem::path MemoryFile::path() const { return fmt::format("/proc/self/fd/{}", fd_); }

Input MemoryFile::Content() const {
  struct stat info {};
  fstat(fd_, &info);
  Input content(static_cast<std::size_t>(info.st_size));
  Demand(pread(fd_, content.data(), content.size(), 0) == static_cast<ssize_t>(content.size()),
         "a file in memory can be read");
  return content;
}

std::uint8_t Cutter::Byte() {
  if (rest_.empty()) return 0;
  const std::uint8_t byte = rest_.front();
  rest_ = rest_.subspan(1);
  return byte;
}

runtime::Bytes Cutter::Datagram() {
  std::size_t size = Byte();
  size = size << 8 | Byte();
  const runtime::Bytes datagram =
      rest_.first(std::min({size, rest_.size(), runtime::kMaxMessageBytes}));
  rest_ = rest_.subspan(datagram.size());
  return datagram;
}

void AddDatagram(runtime::Bytes bytes, Input& input) {
  input.push_back(static_cast<std::uint8_t>(bytes.size() >> 8));
  input.push_back(static_cast<std::uint8_t>(bytes.size()));
  input.insert(input.end(), bytes.begin(), bytes.end());
}

bool Printable(std::string text) {
  std::erase(text, '\n');
  return !HasControlCharacter(text);
}

}  // namespace fogline::fuzz
