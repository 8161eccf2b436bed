// A file that is there as a whole or not at all, whatever happens while it is written.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace fogline {

/// Writes a file under a random name in the folder of the one that it is to be, and renames it at
/// the end. So many processes can write one file at a time: each makes a whole one, and the last
/// one stays. A link to a file stays a link, and the file that it leads to is replaced. A terminal,
/// /dev/null, a pipe and /dev/stdout cannot be replaced: they get the content at the end.
///
/// A process that is to leave nothing behind when it is interrupted watches interrupts
/// (interrupt.h): only kill -9 leaves the file with the random name, ".fogline-*".
class WholeFile {
 public:
  /// @throws InputError if no file can be there, or what is there is a folder or block device
  explicit WholeFile(std::filesystem::path file);
  /// Removes what was written unless Finish() has succeeded.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// @throws std::runtime_error when the disk is full
  void Write(std::string_view text);

  /// The file as long as it has no name, for a library or process to write it instead of Write().
  std::filesystem::path part() const;
  int descriptor() const { return fd_; }

  /// Writes to the disk what is not there yet, so that no power cut leaves half a file under its
  /// name. @throws std::runtime_error when the disk is full
  void Close();

  /// Removes what has the file's name, for files that replace others together.
  /// @throws std::runtime_error
  void RemoveOld();

  /// Replaces what has the file's name, or hands everything to the pipe or device.
  /// @throws std::runtime_error, Interrupted
  void Finish();

 private:
  [[noreturn]] void Fail(int error) const;
  void Flush();
  void HandOver();

  std::filesystem::path file_;
  std::filesystem::path target_;  // file_ without links
  std::filesystem::path part_;    // "" if it has no name at all
  int fd_ = -1;
  int device_ = -1;  // pipe or device
  std::string buffer_;
};

/// Folder of what is given no other place, such as the log of a run.
inline constexpr const char* kDefaultFolder = "logs";

/// Whether a file of this name can be replaced by another: false for a pipe or device, which is
/// written into, and for a name that is an open descriptor of this process, such as /dev/stdout.
bool IsReplaceable(const std::filesystem::path& file);

/// Opens what is not replaceable, to be written into. @return a descriptor
/// @throws InputError "FILE: error: --out: cannot write: no process reads this pipe"
int OpenStream(const std::filesystem::path& file, std::string_view option);

/// Whether what is written there comes out of stdout, so that nothing else should.
bool IsStdout(const std::filesystem::path& file);

/// Requires the folder in which a file or folder is to be made: a missing one is likely to be a
/// typing mistake. kDefaultFolder is made.
/// @param option that names what is to be made, such as "--out"
/// @throws InputError "FILE: error: --out: there is no folder FOLDER"
void RequireFolderOf(const std::filesystem::path& file, std::string_view option);

/// Finds out before long work whether its result could be kept: makes for a moment a file of its
/// own in the folder of `file`. What is there stays as it is.
/// @throws InputError as RequireFolderOf(), or "FILE: error: --out: cannot write: ..."
void RequireWritable(const std::filesystem::path& file, std::string_view option);

/// The same for a folder that is to hold files, whatever their names. It is made if it is missing,
/// the folder in which it is to be is not.
/// @throws InputError as RequireFolderOf(), or "FOLDER: error: --png: cannot write: ..."
void RequireWritableFolder(const std::filesystem::path& folder, std::string_view option);

/// Refuses to replace a file that is there unless `force`, and with it whatever is not of the kind
/// that replaces it: a mistyped name must not cost a file of another kind. An empty file, a pipe
/// and a device have nothing to lose.
/// @param kind such as "sweep"
/// @throws InputError "FILE: error: --out: the file is no sweep and stays as it is, --force or not"
void RefuseToReplace(const std::filesystem::path& file, std::string_view option, bool force,
                     std::string_view kind,
                     const std::function<bool(const std::filesystem::path&)>& is_of_kind);

}  // namespace fogline
