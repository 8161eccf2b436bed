// A file in memory, for a library that reads only files with names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fogline::sumo {

/// A file in memory, which exists until the object is destroyed. After the end of the process, even
/// after a kill, no file remains.
class MemoryFile {
 public:
  /// A file with these lines. @throws std::system_error
  explicit MemoryFile(const std::vector<std::string>& lines);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// A name under which this process can open the file.
  std::string path() const;

 private:
  void Write(std::string_view text) const;

  int fd_;
};

}  // namespace fogline::sumo
