// `fogline export` is stopped or killed when it has written some of its files.
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::StartsWith;
using Words = std::vector<std::string>;
using FilesByName = std::map<std::string, std::string>;  // the contents of each file

/// An export into a folder in which one file is a pipe that no process reads. The export blocks at
/// this pipe after it has written some of its files.
class HaltedExport {
 public:
  HaltedExport(const std::string& log, const std::string& folder, const std::string& file)
      : name_(folder + "/" + file) {
    std::filesystem::remove(name_);
    EXPECT_EQ(mkfifo(name_.c_str(), 0600), 0);
    pipe_ = open(name_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    fcntl(pipe_, F_SETPIPE_SZ, 4096);
    process_.emplace(Words{Program("fogline"), "export", log, "--out", folder, "--force"});
  }
  ~HaltedExport() { close(pipe_); }
  HaltedExport(const HaltedExport&) = delete;
  HaltedExport& operator=(const HaltedExport&) = delete;

  Background& process() { return *process_; }
  bool WaitUntilItWaits() const {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    // The test asks the kernel again and again how full the pipe is, because the kernel reports no
    // event when a pipe is full. The test does not read the pipe, because that would empty it.
    for (int bytes = 0; bytes < 4096; std::this_thread::sleep_for(kLookEvery)) {
      if (ioctl(pipe_, FIONREAD, &bytes) != 0 || std::chrono::steady_clock::now() > end) {
        return false;
      }
    }
    return true;
  }

 private:
  std::string name_;
  int pipe_ = -1;
  std::optional<Background> process_;
};

/// A folder with the export of a run.
class HaltedExportTest : public testing::Test {
 protected:
  HaltedExportTest() {
    Run(log_, "/steps=230");
    EXPECT_EQ(RunCommand({Program("fogline"), "export", log_, "--out", out_}).code, 0);
  }
  static void Run(const std::string& log, const std::string& steps) {
    EXPECT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                          "--set", steps, "--quiet", "--log", log})
                  .code,
              0);
  }

  /// The files in the folder of the export, without pipes.
  FilesByName Files() const {
    FilesByName files;
    for (const auto& entry : std::filesystem::directory_iterator(out_)) {
      if (entry.is_regular_file()) files[entry.path().filename()] = Content(entry.path());
    }
    return files;
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string out_ = folder_.File("csv");
};

TEST_F(HaltedExportTest, EndsOnCtrlCWithAWordAndKeepsTheOlderExport) {
  FilesByName older = Files();
  older.erase("TRUTH.csv");
  HaltedExport halted(log_, out_, "TRUTH.csv");
  ASSERT_TRUE(halted.WaitUntilItWaits()) << halted.process().Err();
  halted.process().Signal(SIGINT);
  EXPECT_EQ(halted.process().Wait(), 130);
  EXPECT_THAT(halted.process().Err(), StartsWith("fogline export: interrupted"));
  EXPECT_TRUE(Files() == older);
}

TEST_F(HaltedExportTest, LeavesNoFolderWithFilesOfTwoLogsWhenItIsKilled) {
  // GIVEN the log of a shorter run
  const std::string other = folder_.File("other.lcm");
  Run(other, "/steps=200");
  FilesByName older = Files();
  older.erase("ACC_COMMAND.csv");
  // WHEN the export of this log is killed before it has written all of its files
  HaltedExport halted(other, out_, "ACC_COMMAND.csv");
  ASSERT_TRUE(halted.WaitUntilItWaits()) << halted.process().Err();
  halted.process().Signal(SIGKILL);
  halted.process().Wait();
  // THEN all files are those of the older export, apart from hidden files that the killed process
  // left
  FilesByName files = Files();
  std::erase_if(files, [](const auto& file) { return file.first.front() == '.'; });
  EXPECT_TRUE(files == older);
  EXPECT_GT(files.size(), 2U);
}

}  // namespace
}  // namespace fogline::test
