#include "common/file.h"

#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/errors.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

using testing::EndsWith;

class FileTest : public testing::Test {
 protected:
  FileTest() {
    for (const char* name : {"paper.json", "dense_fog.json", "paper.lcm", "a.lcm"}) {
      std::ofstream(Path(name)) << "{}";
    }
    std::filesystem::create_directory(Path("papers.json"));
  }
  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }
  std::string Meant(const std::string& name) const {
    return "; did you mean \"" + Path(name).string() + "\"?";
  }

 private:
  test::ScratchFolder folder_;
};

TEST_F(FileTest, SuggestsTheNameThatIsSpeltAlike) {
  EXPECT_EQ(DidYouMeanFile(Path("papr.json")), Meant("paper.json"));
  EXPECT_EQ(DidYouMeanFile(Path("papr.lcm")), Meant("paper.lcm"));
  EXPECT_EQ(DidYouMeanFile(Path("densefog.json")), Meant("dense_fog.json"));
}

TEST_F(FileTest, SuggestsTheNameWithAnotherEndingOrWithOneAtAll) {
  EXPECT_EQ(DidYouMeanFile(Path("paper.jsn")), Meant("paper.json"));
  EXPECT_EQ(DidYouMeanFile(Path("dense_fog")), Meant("dense_fog.json"));
}

TEST_F(FileTest, SuggestsNothingForAnEqualEndingAlone) {
  EXPECT_EQ(DidYouMeanFile(Path("recorded.json")), "");
  EXPECT_EQ(DidYouMeanFile(Path("b.lcm")), "");
}

TEST_F(FileTest, SuggestsNothingWhereThereIsNoFolder) {
  EXPECT_EQ(DidYouMeanFile(Path("nowhere/paper.json")), "");
}

TEST_F(FileTest, HasTheSuggestionInTheErrorOfAFileThatIsNotThereOnly) {
  EXPECT_THAT(ReadFile(Path("papr.json"), 100).error,
              EndsWith("No such file or directory" + Meant("paper.json")));
  EXPECT_THAT(ReadFile(Path("papers.json"), 100).error, EndsWith(": it is a folder"));
  EXPECT_EQ(ReadFile(Path("paper.json"), 100).error, "");
}

TEST_F(FileTest, SuggestsOnlyFilesWithTheEndingThatIsWanted) {
  std::ofstream(Path("papre.csv")) << "a,b";
  EXPECT_EQ(DidYouMeanFile(Path("papre")), Meant("papre.csv"));
  EXPECT_EQ(DidYouMeanFile(Path("papre"), ".json"), Meant("paper.json"));
  EXPECT_THAT(ReadFile(Path("papre"), 100, ".json").error, EndsWith(Meant("paper.json")));
}

TEST_F(FileTest, ReadsAPipeToItsEndThoughItIsOpenedBeforeItsWriterComes) {
  const std::string pipe = Path("pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  // GIVEN a process that still has to start, and that writes in two pieces
  const test::Background writer({"sh", "-c", "exec >'" + pipe + "'; printf one; printf two"});
  FileText read = ReadFile(pipe, 100);
  if (!read.error.empty()) read = ReadFile(pipe, 100);  // a busy machine started sh after 5 s
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.text, "onetwo");
}

TEST_F(FileTest, GivesUpAPipeThatNoProcessWritesInto) {
  const std::string pipe = Path("pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(ReadFile(pipe, 100).error,
            "cannot be read: no process has written into this pipe for 5 s");
}

TEST_F(FileTest, ReadsNoDevice) {
  EXPECT_EQ(ReadFile("/dev/zero", 100).error, "cannot be read: it is neither a file nor a pipe");
}

TEST(ExhaustionTest, IsNoBadInput) {
  EXPECT_NO_THROW(ThrowIfExhausted(ENOENT, "a.lcm"));
  EXPECT_NO_THROW(ThrowIfExhausted(0, "a.lcm"));
  try {
    ThrowIfExhausted(EMFILE, "a.lcm");
    ADD_FAILURE();
  } catch (const InputError&) {
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), "a.lcm: Too many open files; ulimit -n 1024 allows more");
  }
}

}  // namespace
}  // namespace fogline
