// The pictures of README.md and docs/ exist, and tools/pictures makes them.
#include <cstdint>
#include <filesystem>
#include <map>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/pages.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;

/// The alternative text of each picture, by the path of the picture, such as "docs/view.png".
/// Drawings (SVG) are made by hand and left out.
std::map<std::string, std::string> PicturesOfPages() {
  static const std::regex kPicture(R"(!\[([^\]]*)\]\(([^)]+\.png)\))");
  std::map<std::string, std::string> pictures;
  for (const std::filesystem::path& page : Pages()) {
    const std::string text = Content(page);
    for (std::sregex_iterator at(text.begin(), text.end(), kPicture), end; at != end; ++at) {
      const auto file = (page.parent_path() / (*at)[2].str()).lexically_normal();
      pictures[std::filesystem::relative(file, SourceDirectory()).string()] = (*at)[1];
    }
  }
  return pictures;
}

TEST(PicturesTest, AreThereAndSmallAndHaveATextForThoseWhoDoNotSeeThem) {
  constexpr std::uintmax_t kMostBytes = 250'000;
  const auto pictures = PicturesOfPages();
  EXPECT_GE(pictures.size(), 4U);
  for (const auto& [picture, text] : pictures) {
    const std::filesystem::path file = SourceDirectory() / picture;
    ASSERT_TRUE(std::filesystem::exists(file)) << picture;
    EXPECT_LE(std::filesystem::file_size(file), kMostBytes) << picture;
    EXPECT_GE(text.size(), 20U) << picture << ": " << text;
  }
}

TEST(PicturesTest, AreWrittenByToolsPictures) {
  const std::string script = (SourceDirectory() / "tools/pictures").string();
  const Outcome help = RunCommand({script, "--help"});
  ASSERT_EQ(help.code, 0) << help.err;
  const std::string program = Content(SourceDirectory() / "tools/web/pictures.js");
  for (const auto& [picture, text] : PicturesOfPages()) {
    const std::string name = std::filesystem::path(picture).stem().string();
    EXPECT_EQ(picture, "docs/" + name + ".png");
    EXPECT_THAT(help.out, HasSubstr("  " + name + " "));
    EXPECT_THAT(help.out, HasSubstr("  " + picture + ":"));
    EXPECT_TRUE(
        std::regex_search(program, std::regex("const PICTURES = \\{[^}]*\\b" + name + "\\b")))
        << name;
  }
}

}  // namespace
}  // namespace fogline::test
