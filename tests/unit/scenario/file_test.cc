#include "scenario/file.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_THAT(ReadFile(Path("papers.json"), 100).error, EndsWith("Is a directory"));
  EXPECT_EQ(ReadFile(Path("paper.json"), 100).error, "");
}

}  // namespace
}  // namespace fogline
