// Functions with which tests read the pages of the documentation.
#pragma once

#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

/// A block of a page: commands for a shell (a fence "sh", or lines indented by four spaces), or the
/// output of the commands above it (a fence "text").
struct Block {
  bool commands = false;
  std::string text;  // each line ends with \n; without fence or indentation
};

/// The blocks of a page, in their order on the page. Fences of other kinds, such as C++, are left
/// out.
inline std::vector<Block> BlocksOf(const std::string& page) {
  std::vector<Block> blocks;
  std::istringstream lines(page);
  std::string fence;      // first line of the open fence, such as "```sh"; "" outside of a fence
  bool indented = false;  // whether the line before belongs to an indented block
  for (std::string line; std::getline(lines, line);) {
    if (!fence.empty()) {
      if (line == "```") {
        fence.clear();
      } else if (fence == "```sh" || fence == "```text") {
        blocks.back().text += line + "\n";
      }
    } else if (line.starts_with("```")) {
      fence = line;
      indented = false;
      if (fence == "```sh" || fence == "```text") blocks.push_back({fence == "```sh", ""});
    } else if (line.starts_with("    ")) {
      if (!indented) blocks.push_back({true, ""});
      indented = true;
      blocks.back().text += line.substr(4) + "\n";
    } else {
      indented = false;
    }
  }
  return blocks;
}

/// The contents of the first fenced block of a kind, such as "python".
inline std::string FenceOf(const std::string& page, const std::string& kind) {
  const std::string fence = "\n```" + kind + "\n";
  const std::size_t begin = page.find(fence);
  if (begin == std::string::npos) return "";
  const std::size_t text = begin + fence.size();
  return page.substr(text, page.find("```\n", text) - text);
}

/// The paths of README.md and of every page docs/*.md.
inline std::vector<std::filesystem::path> Pages() {
  std::vector<std::filesystem::path> pages{SourceDirectory() / "README.md"};
  for (const auto& entry : std::filesystem::directory_iterator(SourceDirectory() / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }
  return pages;
}

}  // namespace fogline::test
