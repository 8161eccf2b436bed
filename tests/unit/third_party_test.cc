// The tree contains no code of other projects. Packages of npm are the same on every machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <regex>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using nlohmann::json;

/// Whether a file is minified, or says that another project has rights in this file.
bool IsOfAnotherProject(const std::filesystem::path& file, const std::string& text) {
  static const std::regex name(R"(.*\.min\..*|LICEN[CS]E.*|COPYING.*|NOTICE.*)");
  constexpr std::array kNotices{"Copyright", "/*!", "@license", "SPDX-License-Identifier"};
  return std::regex_match(file.filename().string(), name) ||
         std::ranges::any_of(kNotices,
                             [&](const char* notice) { return text.find(notice) != text.npos; });
}

TEST(ThirdPartyTest, HasNoFileInTheTree) {
  int files = 0;
  for (const char* top : {"cmake", "common", "lcmtypes", "scenario", "services", "tools"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(SourceDirectory() / top)) {
      if (!entry.is_regular_file()) continue;
      EXPECT_FALSE(IsOfAnotherProject(entry.path(), Content(entry.path()))) << entry.path();
      ++files;
    }
  }
  EXPECT_GT(files, 500);
}

TEST(ThirdPartyTest, IsKnownByItsNameOrNotice) {
  EXPECT_TRUE(IsOfAnotherProject("tools/report/chart.min.css", ""));
  EXPECT_TRUE(IsOfAnotherProject("tools/chart/LICENSE", ""));
  EXPECT_TRUE(IsOfAnotherProject("tools/chart.js", "/*! chart 1.0 */\nvar chart;\n"));
  EXPECT_TRUE(IsOfAnotherProject("common/ring.h", "// Copyright (c) 2013 The Ring Authors\n"));
  EXPECT_FALSE(IsOfAnotherProject("tools/report/chart.js", "// One panel of a figure.\n"));
}

/// Whether a version is exact: no range, tag or address.
bool IsExact(const std::string& version) {
  static const std::regex exact(R"(\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?)");
  return std::regex_match(version, exact);
}

TEST(ThirdPartyTest, HasAnExactVersionInPackageJson) {
  const json manifest = json::parse(Content(SourceDirectory() / "package.json"));
  const json lock = json::parse(Content(SourceDirectory() / "package-lock.json"));
  ASSERT_FALSE(manifest.at("dependencies").empty());
  EXPECT_EQ(lock.at("packages").at("").at("dependencies"), manifest.at("dependencies"));
  for (const auto& [name, version] : manifest.at("dependencies").items()) {
    EXPECT_TRUE(IsExact(version.get<std::string>())) << name << " " << version;
  }
  EXPECT_FALSE(IsExact("^1.6.32"));
  EXPECT_FALSE(IsExact("latest"));
}

TEST(ThirdPartyTest, IsLockedByHashesAndNotByAddresses) {
  const json lock = json::parse(Content(SourceDirectory() / "package-lock.json"));
  const json& packages = lock.at("packages");
  ASSERT_GT(packages.size(), 1U);
  for (const auto& [folder, package] : packages.items()) {
    EXPECT_FALSE(package.contains("resolved")) << folder;
    if (folder.empty()) continue;  // Fogline itself
    EXPECT_TRUE(IsExact(package.at("version").get<std::string>())) << folder;
    EXPECT_TRUE(package.at("integrity").get<std::string>().starts_with("sha512-")) << folder;
  }
}

}  // namespace
}  // namespace fogline::test
