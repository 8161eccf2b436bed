// Common parts of the tests of `fogline sweep`.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

using Words = std::vector<std::string>;

// Runs of 5 s, which end before the fog begins. They have all measures that need no fog, and they
// take little time.
inline const Words kShort{"--set", "/steps=50"};
inline const Words kThresholds{"--grid", "/arbitrator/threshold=0.2,0.5,0.8"};

inline Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

inline std::int64_t CountLines(const std::string& text) { return std::ranges::count(text, '\n'); }

/// A folder for sweep files, and commands that sweep scenario/paper.json into it.
class SweepFixture : public testing::Test {
 protected:
  std::string File(const std::string& name) const { return folder_.File(name); }

  Words Command(const std::string& out, const Words& more) const {
    return Words{Program("fogline"), "sweep", "scenario/paper.json", "--out", File(out)} + more;
  }
  Outcome Sweep(const std::string& out, const Words& more) const {
    return RunCommand(Command(out, more));
  }
  /// Executes a sweep into a file. @return the bytes of the file
  std::string Made(const std::string& out, const Words& more) const {
    const Outcome outcome = Sweep(out, more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Content(File(out));
  }
  Outcome Merge(const Words& shards, const std::string& out) const {
    Words command{Program("fogline"), "sweep", "--out", File(out), "--merge"};
    for (const std::string& shard : shards) command.push_back(File(shard));
    return RunCommand(command);
  }
  /// Makes shards 1 to `count` as files "I-of-N.csv". @return their names
  Words Shards(int count, const Words& more) const {
    Words names;
    for (int i = 1; i <= count; ++i) {
      names.push_back(std::to_string(i) + "-of-" + std::to_string(count) + ".csv");
      Made(names.back(), more + Words{"--shard", std::to_string(i) + "/" + std::to_string(count)});
    }
    return names;
  }
  /// Waits until a sweep in the background has written `lines` lines. The test reads the file again
  /// and again, because the sweep sends no messages. @return false after kPatience
  bool WaitForLines(const std::string& name, std::int64_t lines) const {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (CountLines(Content(File(name))) < lines) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  Words FilesInFolder() const {
    Words names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename());
    }
    std::ranges::sort(names);
    return names;
  }

  ScratchFolder folder_;
};

}  // namespace fogline::test
