// tools/mutate with a small source tree that the test makes.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kMutations = 150;  // a list must have at least this number of mutations

class MutateTest : public testing::Test {
 protected:
  /// Makes a tree whose function V0 has a unit test, and whose function V1 has a property test. The
  /// other functions have no tests. Each function has a mutation. The list of mutations names the
  /// unit test as the test of every mutation.
  MutateTest() {
    std::filesystem::create_directories(folder_.path() / "tests");
    std::filesystem::copy(SourceDirectory() / "tests/mutations",
                          folder_.path() / "tests/mutations");
    for (const auto& entry :
         std::filesystem::directory_iterator(folder_.path() / "tests/mutations")) {
      if (entry.path().extension() == ".txt") std::filesystem::remove(entry.path());
    }
    std::filesystem::create_directories(folder_.path() / "tools");
    std::filesystem::copy_file(SourceDirectory() / "tools/mutate", folder_.path() / "tools/mutate");
    Write("tools/setup", "#!/bin/sh\n");
    std::filesystem::permissions(folder_.path() / "tools/setup", std::filesystem::perms::owner_all);
    Write("CMakeLists.txt",
          "cmake_minimum_required(VERSION 3.25)\nproject(small CXX)\nenable_testing()\n"
          "add_library(a STATIC services/a.cc)\n"
          "add_executable(unit_tests tests/unit/a_test.cc)\n"
          "add_executable(property_tests tests/property/b_test.cc)\n"
          "target_link_libraries(unit_tests a)\ntarget_link_libraries(property_tests a)\n"
          "add_test(NAME unit.ATest.Zero COMMAND unit_tests)\n"
          "add_test(NAME property.BTest.One COMMAND property_tests)\n");
    Write("tests/unit/a_test.cc",
          "#define TEST(suite, name) int main()\nint V0();\n"
          "TEST(ATest, Zero) { return V0() == 0 ? 0 : 1; }\n");
    Write("tests/property/b_test.cc",
          "#define TEST(suite, name) int main()\nint V1();\n"
          "TEST(BTest, One) { return V1() == 1 ? 0 : 1; }\n");
    std::string code;
    std::string list = "# A list.\n";
    for (int i = 0; i < kMutations; ++i) {
      code += fmt::format("int V{}() {{ return {}; }}\n", i, i);
      list += fmt::format(
          "\nname: v{}\nfile: services/a.cc\ntests: unit.ATest.\n- V{}() {{ return {};\n"
          "+ V{}() {{ return -1;\n{}",
          i, i, i, i, i == 3 ? "equivalent: No program asks for it.\n" : "");
    }
    Write("services/a.cc", code);
    Write("tests/mutations/a.txt", list);
    EXPECT_EQ(RunCommand({"git", "init", "--quiet", folder_.path().string()}).code, 0);
  }

  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((folder_.path() / file).parent_path());
    std::ofstream(folder_.path() / file) << text;
  }
  Outcome Mutate(std::vector<std::string> words) const {
    words.insert(words.begin(), folder_.File("tools/mutate"));
    return RunCommand(words);
  }

  const ScratchFolder folder_;
};

TEST_F(MutateTest, CountsWhatTestsNoticeAndNamesTheSurvivors) {
  const std::string code = Content(folder_.File("services/a.cc"));
  const Outcome first = Mutate({"--only", " v[0-3]$"});
  EXPECT_EQ(first.code, 1) << first.err;
  EXPECT_EQ(first.out,
            "2 of 4 mutations noticed (50.0 %), 1 of them by other tests than the list names\n"
            "  tests/mutations/a.txt:9: v1: property.BTest.One\n"
            "survivor: services/a.cc: v2: NOT EXPLAINED\n"
            "survivor: services/a.cc: v3: No program asks for it.\n");
  EXPECT_THAT(first.err, HasSubstr("v0: noticed by unit.ATest.Zero\n"));
  EXPECT_EQ(Content(folder_.File("services/a.cc")), code);
  // WHEN tools/mutate is called again THEN it tests only the mutations without a known result
  const Outcome again = Mutate({"--only", " v[0-3]$"});
  EXPECT_EQ(again.out, first.out);
  EXPECT_EQ(again.err, "");
  const Outcome noticed = Mutate({"--only", " v0$"});
  EXPECT_EQ(noticed.code, 0);
  EXPECT_THAT(noticed.out, testing::StartsWith("1 of 1 mutations noticed (100.0 %)"));
}

TEST_F(MutateTest, FailsIfATestFailsWithoutAMutation) {
  Write("services/a.cc",
        "int V0() { return 5; }\n" + Content(folder_.File("services/a.cc")).substr(23));
  std::string list = Content(folder_.File("tests/mutations/a.txt"));
  list.replace(list.find("V0() { return 0;"), 16, "V0() { return 5;");
  Write("tests/mutations/a.txt", list);
  const Outcome outcome = Mutate({"--only", " v2$"});
  EXPECT_EQ(outcome.code, 3) << outcome.out;
  EXPECT_THAT(outcome.err, HasSubstr("error: unit.ATest.Zero fails without any mistake\n"));
}

TEST_F(MutateTest, RefusesAMutationThatDoesNotCompile) {
  std::string list = Content(folder_.File("tests/mutations/a.txt"));
  list.replace(list.find("+ V0() { return -1;"), 19, "+ V0() { return x;");
  Write("tests/mutations/a.txt", list);
  const Outcome outcome = Mutate({"--only", " v0$"});
  EXPECT_EQ(outcome.code, 2) << outcome.out;
  EXPECT_THAT(outcome.err, HasSubstr("tests/mutations/a.txt:3: error: v0 does not compile:\n"));
}

TEST_F(MutateTest, ChecksThatEachMutationFitsItsFileOnce) {
  EXPECT_EQ(Mutate({"--check"}).out, "150 mutations fit their files\n");
  Write("services/a.cc", Content(folder_.File("services/a.cc")) + "int V7() { return 7; }\n");
  Write("tests/mutations/b.txt",
        "name: v0\nfile: services/none.cc\ntests: unit.NoTest. perhaps\n- x\n+ y\n\n"
        "name: Same\nfile: services/a.cc\n- V9\n+ V9\n");
  const Outcome outcome = Mutate({"--check"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  for (const char* error :
       {"tests/mutations/a.txt:46: v7: the original occurs 2 times in services/a.cc",
        "tests/mutations/b.txt:1: v0 is also the name at tests/mutations/a.txt:3",
        "tests/mutations/b.txt:1: v0: services/none.cc: No such file or directory",
        "tests/mutations/b.txt:1: v0: there is no suite NoTest in tests/unit",
        "tests/mutations/b.txt:1: v0: perhaps does not begin with PROGRAM.SUITE",
        "tests/mutations/b.txt:7: the name 'Same' is not made of small letters, digits and -"}) {
    EXPECT_THAT(outcome.err, HasSubstr(std::string("tools/mutate: error: ") + error + "\n"));
  }
  Write("tests/mutations/b.txt", "nmae: v0\n");
  EXPECT_THAT(Mutate({"--check"}).err,
              HasSubstr("tests/mutations/b.txt:1: 'nmae: v0' is neither a change nor one of name, "
                        "file, tests, equivalent\n"));
}

}  // namespace
}  // namespace fogline::test
