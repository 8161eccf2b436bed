#include "common/process/programs.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/command.h"

namespace fogline {
namespace {

TEST(ProgramsTest, OwnFolderHasTheProgramOfTheProcess) {
  EXPECT_TRUE(std::filesystem::equivalent(OwnFolder(), test::ProgramDirectory()));
}

/// Sets $PATH while an object of this class exists.
class PathIs {
 public:
  explicit PathIs(const std::string& path) : before_(std::getenv("PATH")) {
    setenv("PATH", path.c_str(), 1);
  }
  ~PathIs() { setenv("PATH", before_.c_str(), 1); }
  PathIs(const PathIs&) = delete;
  PathIs& operator=(const PathIs&) = delete;

 private:
  std::string before_;
};

TEST(ProgramsTest, FindsTheFirstExecutableFileInPath) {
  const test::ScratchFolder folder;
  for (const char* part : {"first", "second", "third"}) {
    std::filesystem::create_directory(folder.path() / part);
    std::ofstream(folder.path() / part / "tool") << "#!/bin/sh\n";
  }
  std::filesystem::create_symlink("loop", folder.path() / "loop");  // no user can search it
  const PathIs path(folder.File("none") + ":" + folder.File("loop") + ":" + folder.File("first") +
                    ":" + folder.File("second") + ":" + folder.File("third"));
  EXPECT_EQ(FindProgram("tool"), "") << "no file is executable";
  for (const char* part : {"third", "second"}) {
    const std::filesystem::path tool = folder.path() / part / "tool";
    std::filesystem::permissions(tool, std::filesystem::perms::owner_all);
    EXPECT_EQ(FindProgram("tool"), tool);
  }
  EXPECT_EQ(FindProgram("other"), "");
  std::filesystem::create_directory(folder.path() / "first/other");
  EXPECT_EQ(FindProgram("other"), "") << "a folder is no program";
}

}  // namespace
}  // namespace fogline
