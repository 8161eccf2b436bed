// A file that is there as a whole or not at all, whatever happens while it is written.
#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace fogline {

/// Writes "FILE.part" and gives it its name at the end. Not for several writers of one file at
/// once.
class WholeFile {
 public:
  /// @throws InputError if no file can be there
  explicit WholeFile(std::filesystem::path file);
  /// Removes what was written unless Finish() has succeeded.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// @throws std::runtime_error when the disk is full
  void Write(std::string_view text);

  /// Replaces what has this name. @throws std::runtime_error
  void Finish();

 private:
  [[noreturn]] void Fail() const;

  std::filesystem::path file_;
  std::filesystem::path part_;
  std::ofstream out_;
};

/// Makes the folder of a file that is to be written. @throws InputError
void MakeFolderOf(const std::filesystem::path& file);

}  // namespace fogline
