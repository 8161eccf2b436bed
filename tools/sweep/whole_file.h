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
  /// @throws InputError if no file can be there, or what is there is a folder or device
  explicit WholeFile(std::filesystem::path file);
  /// Removes what was written unless Finish() has succeeded.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// @throws std::runtime_error when the disk is full
  void Write(std::string_view text);

  /// Where it is until then, for somebody else to write it instead of Write().
  const std::filesystem::path& part() const { return part_; }

  /// Writes what is not yet on the disk. @throws std::runtime_error when it is full
  void Close();

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

/// Finds out before long work whether its result could be kept: makes the folder of `file`, and for
/// a moment a file of its own in it. What is there, "FILE.part", too, stays as it is.
/// @param option that names it, such as "--out"
/// @throws InputError "FILE: error: --out: cannot write: ..."
void RequireWritable(const std::filesystem::path& file, std::string_view option);

/// The same for a folder that is to hold files, whatever their names: makes it.
/// @throws InputError "FOLDER: error: --png: cannot write: ..."
void RequireWritableFolder(const std::filesystem::path& folder, std::string_view option);

}  // namespace fogline
