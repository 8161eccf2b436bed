// A file that is written whole or not at all, even if the process is killed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace fogline {

/// Writes a file under a random name in the folder of the target file, and renames it at the end.
/// So several processes can write the same file at the same time: each writes a complete file, and
/// the last one remains. A link to a file stays a link, and its target is replaced. A terminal,
/// /dev/null, a pipe and /dev/stdout cannot be replaced; they get the content at the end.
///
/// A process that must leave nothing behind after an interrupt watches interrupts (interrupt.h).
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

  /// Path of the file while it has no final name, for a library or process that writes it instead
  /// of Write().
  std::filesystem::path part() const;
  int descriptor() const { return fd_; }

  /// Writes the rest to the disk and syncs it, so that a power cut cannot leave half a file under
  /// the final name. @throws std::runtime_error when the disk is full
  void Close();

  /// Removes the old file of this name. It serves files that belong together, so that no new file
  /// stands beside an old one.
  /// @throws std::runtime_error
  void RemoveOld();

  /// Replaces the old file of this name, or writes everything into the pipe or device.
  /// @throws std::runtime_error, Interrupted
  void Finish();

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

/// Folder of files without a given place, such as the log of a run.
inline constexpr const char* kDefaultFolder = "logs";

/// Whether a file of this name can be replaced. It cannot if it is a pipe or device, into which the
/// bytes are written, or if the name stands for an open descriptor of this process, such as
/// /dev/stdout.
bool IsReplaceable(const std::filesystem::path& file);

/// Opens a file that is not replaceable, for writing. @return a descriptor
/// @throws InputError "FILE: error: --out: cannot write: no process reads this pipe"
int OpenStream(const std::filesystem::path& file, std::string_view option);

/// Whether the file is stdout. Then nothing else should go to stdout.
bool IsStdout(const std::filesystem::path& file);

/// Requires the folder in which a file or folder is to be made. A missing folder is probably a
/// typing mistake, except kDefaultFolder, which is made.
/// @param option that names the file or folder to be made, such as "--out"
void RequireFolderOf(const std::filesystem::path& file, std::string_view option);

/// Checks before long work whether its result can be written: it makes a temporary file in the
/// folder of `file`. An existing file stays as it is.
/// @throws InputError as RequireFolderOf(), or "FILE: error: --out: cannot write: ..."
void RequireWritable(const std::filesystem::path& file, std::string_view option);

/// The same for a folder that is to hold files of any name. A missing folder is made, but its
/// parent folder is not.
/// @throws InputError as RequireFolderOf(), or "FOLDER: error: --png: cannot write: ..."
void RequireWritableFolder(const std::filesystem::path& folder, std::string_view option);

/// Refuses to replace an existing file unless `force` is true. Even with `force` it refuses a file
/// of another kind: the name may be mistyped. An empty file is accepted with `force`, a pipe and a
/// device are always accepted.
/// @param kind such as "sweep"
/// @throws InputError "FILE: error: --out: the file is no sweep and is not replaced, even with
/// --force"
void RefuseToReplace(const std::filesystem::path& file, std::string_view option, bool force,
                     std::string_view kind,
                     const std::function<bool(const std::filesystem::path&)>& is_of_kind);

}  // namespace fogline
