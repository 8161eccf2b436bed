// An experiment with the real programs, for tests: each trial is a short run in real time.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace fogline::test {

inline constexpr int kParticipants = 4;

/// The answers of one run: Enter, six scales of workload, one scale of sleepiness. The answers
/// depend on the sum of participant number and run number.
inline std::string AnswersOf(int participant, int run) {
  std::string lines = "\n";
  for (int scale = 0; scale < 6; ++scale) {
    lines += fmt::format("{}\n", 5 * (participant + run + scale));
  }
  return lines + fmt::format("{}\n", participant + run);
}

/// An experiment with four participants and three conditions. Each run has 80 steps of 0.1 s, at
/// ten times real speed.
class ExperimentFixture : public ::testing::Test {
 protected:
  ExperimentFixture() {
    const std::string paper = (SourceDirectory() / "scenario/paper.json").string();
    const auto condition = [&paper](const std::string& name, double threshold) {
      return nlohmann::json{
          {"name", name},
          {"scenario", paper},
          {"set", {"/steps=80", fmt::format("/arbitrator/threshold={}", threshold)}}};
    };
    const nlohmann::json plan{
        {"version", 1},
        {"title", "Test"},
        {"participants", kParticipants},
        {"seeds", "trial"},
        {"speed", 10},
        {"conditions", {condition("low", 0.2), condition("mid", 0.5), condition("high", 0.8)}},
        {"breaks", {{{"after_trial", 1}, {"at_least_s", 0.1}}}},
        {"questionnaires",
         {{{"name", "tlx"}, {"kind", "nasa_tlx"}}, {{"name", "kss"}, {"kind", "kss"}}}}};
    std::ofstream(file_) << plan.dump(2);
  }

  /// A shell command that makes the trials of a participant from run `first` on. The answers come
  /// from AnswersOf(). `options` are further options of `experiment run`.
  std::vector<std::string> Session(int participant, int first = 1,
                                   const std::string& options = "") const {
    const std::string input = folder_.File(fmt::format("answers-{}-{}.txt", participant, first));
    std::ofstream answers(input);
    for (int run = first; run <= 3; ++run) answers << AnswersOf(participant, run);
    return {"sh", "-c",
            fmt::format("exec {} experiment run {} --results {} --participant {} --no-page {} < {}",
                        Program("fogline"), file_, results_, participant, options, input)};
  }

  Outcome Experiment(const std::string& action, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command{Program("fogline"), "experiment", action, file_,
                                     "--results",        results_};
    command.insert(command.end(), more.begin(), more.end());
    return RunCommand(command);
  }

  /// The rows of trials.csv, by the names of the columns.
  /// @param code the exit code that the export must have; it is 1 if trials are missing
  std::vector<std::map<std::string, std::string>> ExportedTrials(int code = 0) const {
    const std::string out = folder_.File("tables");
    const Outcome outcome = Experiment("export", {"--out", out, "--force"});
    EXPECT_EQ(outcome.code, code) << outcome.err;
    std::istringstream lines(Content(out + "/trials.csv"));
    std::vector<std::vector<std::string>> table;
    for (std::string line; std::getline(lines, line);) {
      auto& row = table.emplace_back();
      std::istringstream cells(line + ",");
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    }
    std::vector<std::map<std::string, std::string>> rows;
    for (std::size_t i = 1; i < table.size(); ++i) {
      EXPECT_EQ(table[i].size(), table[0].size()) << "row " << i;
      auto& row = rows.emplace_back();
      for (std::size_t k = 0; k < table[i].size(); ++k) row[table[0][k]] = table[i][k];
    }
    return rows;
  }

  ScratchFolder folder_;
  std::string file_ = folder_.File("experiment.json");
  std::string results_ = folder_.File("results");
};

}  // namespace fogline::test
