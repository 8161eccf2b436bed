#include "services/runtime/wire/build_id.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "tests/support/command.h"

namespace fogline {
namespace {

std::vector<std::uint8_t> Content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The build id of a program according to binutils.
std::string ReadelfOf(const std::string& program) {
  const std::string notes = test::RunCommand({"readelf", "--notes", program}).out;
  std::smatch id;
  static const std::regex kId("Build ID: ([0-9a-f]{16})");
  return std::regex_search(notes, id, kId) ? id[1].str() : "none";
}

TEST(BuildIdTest, IsTheBeginningOfTheProgramsGnuBuildId) {
  for (const char* name : {"fogline", "fogline-driver"}) {
    const std::string program = test::Program(name);
    EXPECT_EQ(runtime::BuildText(runtime::BuildIdOf(program)), ReadelfOf(program)) << name;
  }
  EXPECT_EQ(runtime::OwnBuildId(), runtime::BuildIdOf("/proc/self/exe"));
}

TEST(BuildIdTest, TellsProgramsApart) {
  EXPECT_NE(runtime::BuildIdOf(test::Program("fogline-driver")), runtime::kUnknownBuild);
  EXPECT_NE(runtime::BuildIdOf(test::Program("fogline-driver")),
            runtime::BuildIdOf(test::Program("fogline-acc")));
}

TEST(BuildIdTest, IsUnknownWhereAFileHasNone) {
  EXPECT_EQ(runtime::BuildIdOf("/no/such/program"), runtime::kUnknownBuild);
  EXPECT_EQ(runtime::BuildIdOf("/"), runtime::kUnknownBuild);
  EXPECT_EQ(runtime::BuildIdOf(test::SourceDirectory() / "README.md"), runtime::kUnknownBuild);
  EXPECT_EQ(runtime::BuildText(runtime::kUnknownBuild), "unknown");
}

TEST(BuildIdTest, ReadsNothingBehindTheEndOfAFileThatIsCutAnywhere) {
  const std::vector<std::uint8_t> program = Content(test::Program("fogline-driver"));
  const runtime::BuildId whole = runtime::BuildIdIn(program);
  constexpr std::size_t kNotesEnd = 4096;
  for (std::size_t size = 0; size < kNotesEnd; ++size) {
    // A separate block, so that a sanitizer finds a read beyond the end of the block.
    const std::vector<std::uint8_t> cut(program.begin(),
                                        program.begin() + static_cast<std::ptrdiff_t>(size));
    const runtime::BuildId id = runtime::BuildIdIn(cut);
    EXPECT_TRUE(id == whole || id == runtime::kUnknownBuild) << size << " bytes";
  }
}

}  // namespace
}  // namespace fogline
