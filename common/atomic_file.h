// A file that is written completely or not at all, even if the process is killed.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace fogline {

/// Writes a file under a random name in the folder of the target file, and renames it at the end.
/// So several processes can write the same file at the same time. Each process writes a complete
/// file. The file that is renamed last remains; with FinishNew(), the first file remains. If the
/// name is a link, the link stays and its target is replaced. A terminal, /dev/null, a pipe and
/// /dev/stdout cannot be replaced; Finish() writes the content into them.
///
/// A process that must leave no temporary file after an interrupt calls WatchInterrupts()
/// (interrupt.h). Then only kill -9 leaves a file with a random name, ".fogline-*".
class AtomicFile {
 public:
  /// @throws InputError if the file cannot be created, or if a folder or a block device has this
  ///     name
  explicit AtomicFile(std::filesystem::path file);
  /// Removes the temporary file, if it still exists.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Adds text to the file. @throws std::runtime_error when the disk is full
  void Write(std::string_view text);

  /// Whether a file has the name of a temporary file.
  static bool IsTemporary(const std::filesystem::path& file);

  /// Path of the temporary file. A library can open this path and write the content, in place of
  /// Write().
  std::filesystem::path part() const;
  int descriptor() const { return fd_; }

  /// Writes the buffered text and syncs the file. So a power cut does not leave an incomplete file
  /// under the final name. @throws std::runtime_error when the disk is full
  void Close();

  /// Removes the old file of this name, if there is one.
  /// @throws std::runtime_error
  void RemoveOld();

  /// Replaces the old file of this name, or writes everything into the pipe or device.
  /// @throws std::runtime_error, Interrupted
  void Finish();

  /// Gives the file its name only if no file has this name. If several processes call FinishNew()
  /// for the same name at the same time, only one process succeeds. This is not guaranteed on a
  /// file system that has neither hard links nor RENAME_NOREPLACE (renameat2(2)).
  /// @pre !is_stream()
  /// @return false if there is a file of this name, which stays unchanged
  /// @throws std::runtime_error
  bool FinishNew();

  /// Whether Finish() writes into a pipe or device.
  bool is_stream() const { return device_ >= 0; }

 private:
  [[noreturn]] void Fail(int error) const;
  void Flush();
  void HandOver();

  std::filesystem::path file_;
  std::filesystem::path target_;  // file_ with links resolved
  std::filesystem::path part_;    // name of the temporary file; "" if it has no name
  int fd_ = -1;
  int device_ = -1;  // descriptor of the pipe or device; -1 if there is none
  std::string buffer_;
};

/// Files that belong together. All new files are on the disk before the first old file is replaced.
/// So the old files stay unchanged if the disk is full.
class AtomicFiles {
 public:
  /// Adds a file. The reference is valid for the lifetime of this object. @throws as AtomicFile()
  AtomicFile& Add(std::filesystem::path file) { return files_.emplace_back(std::move(file)); }

  /// Finishes all files as AtomicFile::Finish() does, but removes all old files before the first
  /// new one gets its name. So the folder never contains a new file beside an old one, even if the
  /// process is killed. The file that was added last is removed first, and gets its name last. So a
  /// folder that contains this file contains all files. Writes to pipes and devices can fail, so
  /// they come before the removal of files.
  /// @throws std::runtime_error, Interrupted
  void Finish();

 private:
  std::deque<AtomicFile> files_;
};

/// Default folder of output files, such as the log of a run.
inline constexpr const char* kDefaultFolder = "logs";

/// Whether a file of this name can be replaced. The result is false for a pipe, for a device, and
/// for a name of an open descriptor of this process, such as /dev/stdout. For such a name,
/// AtomicFile writes into the existing file and renames no file.
bool IsReplaceable(const std::filesystem::path& file);

/// Opens a pipe, a device or an open descriptor for writing; for these, IsReplaceable() is false.
/// @return a descriptor
/// @throws InputError "FILE: error: --out: cannot write: no process reads this pipe"
int OpenStream(const std::filesystem::path& file, std::string_view option);

/// Whether the file is stdout. In this case, the program should write no other text to stdout.
bool IsStdout(const std::filesystem::path& file);

/// Throws if the parent folder of a new file or folder does not exist. In this case, the parent's
/// name is probably mistyped. If the missing folder is kDefaultFolder, the function creates it
/// instead.
/// @param option the command line option that names the new file or folder, such as "--out"
void RequireFolderOf(const std::filesystem::path& file, std::string_view option);

/// Checks before long work whether the result can be written. For this check, the function creates
/// and removes a temporary file in the folder of `file`. An existing file stays unchanged.
/// @throws InputError as RequireFolderOf(), or "FILE: error: --out: cannot write: ..."
void RequireWritable(const std::filesystem::path& file, std::string_view option);

/// A folder for output files of any name, checked before long work. The constructor creates a
/// missing folder, whose parent folder must exist as in RequireFolderOf(). The destructor removes a
/// new folder that is still empty.
class OutputFolder {
 public:
  /// @throws InputError as RequireFolderOf(), or "FOLDER: error: --png: cannot write: ..."
  OutputFolder(std::filesystem::path folder, std::string_view option);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  void Leave() const;

  std::filesystem::path folder_;
  bool is_new_ = false;
};

/// Refuses to replace an existing file unless `force` is true. Even with `force`, the function
/// refuses a file of another kind, because the name may be mistyped. With `force`, an empty file is
/// accepted. A folder is never accepted. A pipe and a device are always accepted.
/// @param kind such as "sweep"
/// @throws InputError "FILE: error: --out: the file is no sweep and is not replaced, even with
/// --force"
void RefuseToReplace(const std::filesystem::path& file, std::string_view option, bool force,
                     std::string_view kind,
                     const std::function<bool(const std::filesystem::path&)>& is_of_kind);

}  // namespace fogline
