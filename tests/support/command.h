// Real programs in tests. They run to their end, or in the background until the test ends.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fogline::test {

/// The interval at which a test checks a condition outside of its process.
inline constexpr std::chrono::milliseconds kLookEvery(5);
/// A time limit that ends only tests that hang. It is many times the time that a busy machine needs
/// to start a program, a Java virtual machine or a browser, to deliver a message, or to compute a
/// small study.
inline constexpr std::chrono::seconds kPatience(280);

/// The folder of the built programs, and the folder of the sources.
std::filesystem::path ProgramDirectory();
std::filesystem::path SourceDirectory();
/// The path of a program of this build, such as "fogline".
std::string Program(const std::string& name);

/// A program in the background. The destructor ends it and removes its output.
class Background {
 public:
  /// Starts the program in a process group of its own, in the source folder. stdout and stderr go
  /// into files.
  explicit Background(const std::vector<std::string>& command);
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  pid_t pid() const { return pid_; }
  void Signal(int signal) const;
  /// Waits for the end. @return the exit code, or 128 + signal. After the time limit the program is
  /// killed, and the result is -1.
  int Wait(std::chrono::seconds limit = kPatience);
  std::string Out() const;
  std::string Err() const;
  /// Waits until stderr (or stdout) contains `text`. @return false after the time limit, or if the
  /// program ends without this text
  bool WaitForErr(const std::string& text, std::chrono::seconds limit = kPatience);
  bool WaitForOut(const std::string& text, std::chrono::seconds limit = kPatience);

 private:
  bool WaitFor(const std::filesystem::path& file, const std::string& text,
               std::chrono::seconds limit);

  std::filesystem::path directory_;
  pid_t pid_ = -1;
  int status_ = -1;
  bool ended_ = false;
};

struct Outcome {
  int code;
  std::string out;
  std::string err;
};

/// Executes a command again and again until its stdout contains all `texts`. On a busy machine, a
/// single execution may not print all texts. @return the last outcome; after kPatience, it may lack
/// a text
Outcome RunUntilItPrints(const std::vector<std::string>& command,
                         const std::vector<std::string>& texts);

/// Waits until a file has at least `bytes` bytes. @return false after the time limit
bool GrowsTo(std::uintmax_t bytes, const std::filesystem::path& file,
             std::chrono::seconds limit = kPatience);

/// Waits until a file contains a text. @return false after the time limit
bool ComesToHave(const std::string& text, const std::filesystem::path& file,
                 std::chrono::seconds limit = kPatience);

/// The bytes of a file; "" if there is no such file.
std::string Content(const std::filesystem::path& file);

/// Runs a program to its end.
Outcome RunCommand(const std::vector<std::string>& command, std::chrono::seconds limit = kPatience);

/// Whether a process with this id exists (a zombie does not count).
bool IsAlive(pid_t pid);

/// The process id of a role in a text such as "processes: world 4711, radar 4712"; 0 if the text
/// does not contain the role.
pid_t PidOf(const std::string& err, const std::string& role);

/// An empty folder below Testing/tmp in the build folder. The destructor removes the folder. If a
/// test is killed, tools/test removes its folder.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string File(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// The beginning of a command line, to which a test appends a command. This command finds a `make`
/// that always fails, as if the system were a fresh Debian without make.
std::vector<std::string> WithoutMake(const ScratchFolder& folder);

}  // namespace fogline::test
