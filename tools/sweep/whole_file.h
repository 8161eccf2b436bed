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

/// Folder of what is given no other place, such as the log of a run.
inline constexpr const char* kDefaultFolder = "logs";

/// Requires the folder in which a file or folder is to be made: a missing one is likely to be a
/// typing mistake. kDefaultFolder is made.
/// @param option that names what is to be made, such as "--out"
/// @throws InputError "FILE: error: --out: there is no folder FOLDER"
void RequireFolderOf(const std::filesystem::path& file, std::string_view option);

/// Finds out before long work whether its result could be kept: makes for a moment a file of its
/// own in the folder of `file`. What is there, "FILE.part", too, stays as it is.
/// @throws InputError as RequireFolderOf(), or "FILE: error: --out: cannot write: ..."
void RequireWritable(const std::filesystem::path& file, std::string_view option);

/// The same for a folder that is to hold files, whatever their names. It is made if it is missing,
/// the folder in which it is to be is not.
/// @throws InputError as RequireFolderOf(), or "FOLDER: error: --png: cannot write: ..."
void RequireWritableFolder(const std::filesystem::path& folder, std::string_view option);

}  // namespace fogline
