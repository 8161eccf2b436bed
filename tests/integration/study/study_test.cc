// `fogline study` as a person uses it.
#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/decision/conflict/conflict_measures.h"
#include "tests/integration/study/study_runs.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// The files of a folder by name, with their bytes.
std::vector<std::pair<std::string, std::string>> Files(const std::filesystem::path& folder) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.emplace_back(entry.path().filename(), ReadText(entry.path()));
  }
  std::ranges::sort(files);
  return files;
}

/// The number of rows of conflict.csv for each measure. The fifth column has the measure.
std::map<std::string, int> CountByMeasure(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::map<std::string, int> counts;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i < 5; ++i) std::getline(cells, cell, ',');
    ++counts[cell];
  }
  return counts;
}

/// Expects that the page of the conflict study explains its delays: they run from the fog to the
/// alarm, and are not the measure deception_to_alarm_s of a run.
void ExpectDelaysFromFogToAlarm(const std::string& page) {
  EXPECT_THAT(page, HasSubstr("<th scope=\"col\">fog to alarm (s)</th>"));
  EXPECT_THAT(page, HasSubstr("This delay is not deception_to_alarm_s of a run"));
}

TEST(StudyVerbTest, WritesWhatItSaysAndTheSameBytesWhateverTheNumberOfJobs) {
  const ScratchFolder folder;
  // WHEN the study of conflict measures is computed twice, with one job and with two
  const std::string one = folder.File("one");
  const std::string two = folder.File("two");
  const Outcome first =
      Study({"conflict", "--seeds", "1:3", "--jobs", "1", "--out", one, "--json"});
  const Outcome second = Study({"conflict", "--seeds", "1:3", "--jobs", "2", "--out", two});
  ASSERT_EQ(first.code, 0) << first.err;
  ASSERT_EQ(second.code, 0) << second.err;
  // THEN the files that the verb names exist, and both calls write the same bytes
  const nlohmann::json said = nlohmann::json::parse(first.out);
  EXPECT_EQ(said["studies"][0]["seeds"], "1:3");
  EXPECT_TRUE(std::filesystem::exists(said["report"].get<std::string>()));
  for (const auto& file : said["studies"][0]["files"]) {
    EXPECT_TRUE(std::filesystem::exists(file.get<std::string>())) << file;
  }
  EXPECT_EQ(Files(one), Files(two));
  EXPECT_EQ(said["text"], one + "/conflict.md");
  // The output names all files; the page and its text come last.
  EXPECT_THAT(second.out, testing::EndsWith(two + "/conflict.html\n" + two + "/conflict.md\n"));
  for (const auto& [name, content] : Files(two)) EXPECT_THAT(second.out, HasSubstr(name + "\n"));
  // AND the table has every detector in two fog models, five visibilities and four noises
  const std::map<std::string, int> detectors = CountByMeasure(ReadText(one + "/conflict.csv"));
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    EXPECT_TRUE(detectors.contains(std::string(row.name))) << row.name;
  }
  EXPECT_TRUE(detectors.contains("nis + window + sign"));
  for (const auto& [detector, rows] : detectors) EXPECT_EQ(rows, 2 * 5 * 4) << detector;
  EXPECT_THAT(ReadText(one + "/conflict.md"), HasSubstr(said["studies"][0]["answer"]));
  ExpectDelaysFromFogToAlarm(ReadText(one + "/conflict.html"));
}

void ExpectAtMostThreeSentencesWithoutNumbers(const std::string& answer) {
  EXPECT_LE(std::ranges::count(answer, '.'), 3) << answer;
  EXPECT_TRUE(answer.ends_with('.')) << answer;
  EXPECT_TRUE(std::ranges::none_of(answer, [](unsigned char c) { return std::isdigit(c); }))
      << answer;
}

/// Expects that no claim has the state "holds". @return the number of claims that say that there
/// are too few runs for an interval
std::size_t OpenClaims(const nlohmann::json& claims) {
  for (const auto& claim : claims) EXPECT_NE(claim["state"], "holds") << claim;
  return static_cast<std::size_t>(std::ranges::count_if(
      claims, [](const auto& claim) { return claim["found"] == "too few runs for an interval"; }));
}

TEST(StudyVerbTest, MakesOnePageOfAllStudiesAndOneRunEachLeavesTheirClaimsOpen) {
  const ScratchFolder folder;
  const Outcome all = Study({"all", "--seeds", "1", "--out", folder.path(), "--json"});
  ASSERT_EQ(all.code, 0) << all.err;
  const std::string page = ReadText(folder.File("studies.html"));
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  const nlohmann::json said = nlohmann::json::parse(all.out);
  EXPECT_EQ(said["studies"].size(), 9U);
  std::size_t open = 0;
  for (const auto& study : said["studies"]) {
    const std::string name = study["name"];
    EXPECT_THAT(page, HasSubstr("<section id=\"" + name + "\""));
    EXPECT_TRUE(std::filesystem::exists(folder.File(name + ".csv")));
    EXPECT_GE(study["claims"].size(), 3U) << name;
    open += OpenClaims(study["claims"]);
    ExpectAtMostThreeSentencesWithoutNumbers(study["answer"]);
  }
  EXPECT_GE(open, 20U);
}

/// The rows of a study's CSV file, as text, by variant and then by case.
std::map<std::string, std::map<std::string, std::string>> ByVariantAndCase(const std::string& csv) {
  std::map<std::string, std::map<std::string, std::string>> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    const std::size_t one = line.find(',');
    const std::size_t two = line.find(',', one + 1);
    rows[line.substr(one + 1, two - one - 1)][line.substr(0, one)] += line.substr(two) + '\n';
  }
  return rows;
}

TEST(StudyVerbTest, EveryCarOfTheVehicleStudyDrivesInAWayOfItsOwn) {
  const ScratchFolder folder;
  const Outcome made = Study({"vehicle", "--seeds", "1:2", "--out", folder.path()});
  ASSERT_EQ(made.code, 0) << made.err;
  const auto variants = ByVariantAndCase(ReadText(folder.File("vehicle.csv")));
  ASSERT_EQ(variants.size(), 3U);
  for (const auto& [variant, cases] : variants) {
    EXPECT_GT(cases.size(), 10U);
    std::map<std::string, std::string> by_measures;
    for (const auto& [name, measures] : cases) {
      const auto [other, is_new] = by_measures.emplace(measures, name);
      EXPECT_TRUE(is_new) << variant << ": " << name << " is the same as " << other->second;
    }
  }
}

TEST(StudyVerbTest, TriesItsFolderBeforeItComputes) {
  const ScratchFolder folder;
  const std::string file = folder.File("file");
  std::ofstream(file) << "in the way";
  // This study would take an hour, so the verb must refuse the folder before it computes.
  const Outcome refused = Study({"policy", "--seeds", "1:100000", "--out", file + "/studies"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("/file/studies: error: --out: cannot write: "));
}

TEST(StudyVerbTest, RefusesWhatItCannotFollow) {
  const Outcome name = Study({"levitate"});
  EXPECT_EQ(name.code, 2);
  EXPECT_THAT(name.err, StartsWith("fogline study: error: no study \"levitate\"; there are "));
  const Outcome seeds = Study({"policy", "--seeds", "3:1"});
  EXPECT_EQ(seeds.code, 2);
  const Outcome many = Study({"policy", "--seeds", "0:8734253822779143"});
  EXPECT_EQ(many.code, 2);
  EXPECT_THAT(many.err, StartsWith("fogline study: error: --seeds 0:8734253822779143: more than "));
  const Outcome folder = Study({"policy", "--seeds", "1", "--scenarios", "/nowhere"});
  EXPECT_EQ(folder.code, 2);
  EXPECT_EQ(folder.err,
            "/nowhere/paper.json: error: --scenarios: there is no such file; the option names the "
            "folder with paper.json and dense_fog.json. In Fogline's sources it is scenario/\n");
  const std::string long_name(300, 'x');
  EXPECT_EQ(Study({"policy", "--seeds", "1", "--scenarios", long_name}).err,
            long_name + "/paper.json: error: --scenarios: File name too long\n");
  const ScratchFolder without_sets;
  for (const char* file : {"paper.json", "dense_fog.json"}) {
    std::filesystem::copy(SourceDirectory() / "scenario" / file, without_sets.path());
  }
  const Outcome sets = Study({"ensemble", "--seeds", "1", "--scenarios", without_sets.path()});
  EXPECT_EQ(sets.code, 2);
  EXPECT_THAT(sets.err, StartsWith(without_sets.File("ensemble/sets.csv") +
                                   ": error: --scenarios: there is no such file; "));
}

/// Waits until a program has begun to compute on several threads.
bool WaitForThreads(pid_t pid) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  const std::filesystem::path tasks = "/proc/" + std::to_string(pid) + "/task";
  while (std::chrono::steady_clock::now() < end) {
    std::error_code gone;
    const std::filesystem::directory_iterator threads(tasks, gone);
    if (gone) return false;
    if (std::distance(begin(threads), std::filesystem::end(threads)) > 1) return true;
    std::this_thread::sleep_for(kLookEvery);
  }
  return false;
}

TEST(StudyVerbTest, AnInterruptLeavesNoFileOfTheStudyThatItStops) {
  const ScratchFolder folder;
  const std::string out = folder.File("never");
  Background study({Program("fogline"), "study", "conflict", "--seeds", "1:100000", "--jobs", "2",
                    "--out", out});
  ASSERT_TRUE(WaitForThreads(study.pid())) << study.Err();
  study.Signal(SIGINT);
  EXPECT_EQ(study.Wait(), 130);
  EXPECT_EQ(study.Err(),
            "fogline study: interrupted in study conflict; its files are not written\n");
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace fogline::test
