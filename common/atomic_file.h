// A file that is written whole or not at all, even if the process is killed.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace fogline {

/// Writes a file under a random name in the folder of the target file, and renames it at the end.
/// So several processes can write the same file at the same time. Each writes a complete file, and
/// the last file remains. A link to a file stays a link, and its target is replaced. A terminal,
/// /dev/null, a pipe and /dev/stdout cannot be replaced; they get the content at the end.
///
/// A process that must leave no such file after an interrupt calls WatchInterrupts() (interrupt.h).
/// Then only kill -9 leaves the file with the random name, ".fogline-*".
class AtomicFile {
 public:
  /// @throws InputError if the file cannot be created, or a folder or block device has its name
  explicit AtomicFile(std::filesystem::path file);
  /// Removes the written part unless Finish() has succeeded.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// @throws std::runtime_error when the disk is full
  void Write(std::string_view text);

  /// Path of the file before Finish(). A library or another process can write the file by this
  /// path, in place of Write().
  std::filesystem::path part() const;
  int descriptor() const { return fd_; }

  /// Writes the buffered text and syncs the file. So a power cut does not leave an incomplete file
  /// under the final name. @throws std::runtime_error when the disk is full
  void Close();

  /// Removes the old file of this name.
  /// @throws std::runtime_error
  void RemoveOld();

  /// Replaces the old file of this name, or writes everything into the pipe or device.
  /// @throws std::runtime_error, Interrupted
  void Finish();

  /// Whether Finish() writes into a pipe or device.
  bool is_stream() const { return device_ >= 0; }

 private:
  [[noreturn]] void Fail(int error) const;
  void Flush();
  void HandOver();

  std::filesystem::path file_;
  std::filesystem::path target_;  // file_ with links resolved
  std::filesystem::path part_;    // "" if the file has no name at all
  int fd_ = -1;
  int device_ = -1;  // pipe or device
  std::string buffer_;
};

/// Files that belong together. No old file is replaced before all new ones are on the disk, so the
/// old files stay as they are when the disk is full.
class AtomicFiles {
 public:
  /// Adds a file. The reference is valid as long as this object. @throws as AtomicFile()
  AtomicFile& Add(std::filesystem::path file) { return files_.emplace_back(std::move(file)); }

  /// Removes all old files before the first new one gets its name. So a new file never stands
  /// beside an old one, even if the process is killed. The last file is removed first and gets its
  /// name last, so a folder that has the last file has all of them. Pipes and devices, which can
  /// fail, get their content before any file is removed. @throws std::runtime_error, Interrupted
  void Finish();

 private:
  std::deque<AtomicFile> files_;
};

/// Folder of files without a given place, such as the log of a run.
inline constexpr const char* kDefaultFolder = "logs";

/// Whether a file of this name can be replaced. The result is false for a pipe, for a device, and
/// for a name of an open descriptor of this process, such as /dev/stdout. Bytes are written into
/// these.
bool IsReplaceable(const std::filesystem::path& file);

/// Opens a file that is not replaceable, for writing. @return a descriptor
/// @throws InputError "FILE: error: --out: cannot write: no process reads this pipe"
int OpenStream(const std::filesystem::path& file, std::string_view option);

/// Whether the file is stdout. Then nothing else should go to stdout.
bool IsStdout(const std::filesystem::path& file);

/// Throws if the folder in which a file or folder is to be made does not exist, because its name is
/// probably mistyped. Only kDefaultFolder is made if it does not exist.
/// @param option that names the file or folder to be made, such as "--out"
void RequireFolderOf(const std::filesystem::path& file, std::string_view option);

/// Checks before long work whether the result can be written. For this, it makes a temporary file
/// in the folder of `file`. An existing file stays as it is.
/// @throws InputError as RequireFolderOf(), or "FILE: error: --out: cannot write: ..."
void RequireWritable(const std::filesystem::path& file, std::string_view option);

/// A folder that is to hold files of any name, checked before long work. A missing folder is made,
/// but its parent folder is not. The destructor removes a new folder that is still empty.
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

/// Refuses to replace an existing file unless `force` is true. Even with `force` it refuses a file
/// of another kind, because the name may be mistyped. An empty file is replaced with `force`. A
/// pipe and a device are always accepted.
/// @param kind such as "sweep"
/// @throws InputError "FILE: error: --out: the file is no sweep and is not replaced, even with
/// --force"
void RefuseToReplace(const std::filesystem::path& file, std::string_view option, bool force,
                     std::string_view kind,
                     const std::function<bool(const std::filesystem::path&)>& is_of_kind);

}  // namespace fogline
