// `fogline report` as a person uses it: pages of logs, and pages of curves, which need no log.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Outcome Report(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {Program("fogline"), "report"});
  return RunCommand(arguments);
}

/// The data that the page gives to its script.
nlohmann::json DataOf(const std::string& page) {
  constexpr std::string_view kBegin = "id=\"report-data\">";
  const std::size_t from = page.find(kBegin) + kBegin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

/// Makes the log of a short run of the paper's scenario. @return its path
std::string Log(const ScratchFolder& folder, const std::string& name,
                const std::vector<std::string>& more) {
  std::vector<std::string> command{Program("fogline"), "run",     "scenario/paper.json",
                                   "--transport",      "direct",  "--set",
                                   "/steps=220",       "--quiet", "--log",
                                   folder.File(name)};
  command.insert(command.end(), more.begin(), more.end());
  const Outcome run = RunCommand(command);
  EXPECT_EQ(run.code, 0) << run.err;
  return folder.File(name);
}

std::string FolderOf(const ScratchFolder& folder) {
  return std::filesystem::path(folder.File("log")).parent_path().string();
}

TEST(ReportVerbTest, DrawsTheValuesOfTheTable) {
  // GIVEN the page of the curves, and the table of the same thresholds and seeds
  const ScratchFolder folder;
  const std::string file = folder.File("report.html");
  const Outcome report = Report({"--curves", "scenario/paper.json", "--thresholds", "0.2:0.8:7",
                                 "--seeds", "3:12", "--output", file});
  ASSERT_EQ(report.code, 0) << report.err;
  const Outcome table = RunCommand({Program("fogline"), "table", "scenario/paper.json",
                                    "--thresholds", "0.2:0.8:7", "--seeds", "3:12", "--json"});
  ASSERT_EQ(table.code, 0) << table.err;
  // THEN curves and table agree to the last bit
  const nlohmann::json curves = DataOf(Content(file))["curves"];
  const nlohmann::json rows = nlohmann::json::parse(table.out)["rows"];
  ASSERT_EQ(rows.size(), 7U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(curves["thresholds"][i], rows[i]["threshold"]);
    EXPECT_EQ(curves["si"]["mean"][i], rows[i]["si_pct"]);
    EXPECT_EQ(curves["si"]["ci95"][i], rows[i]["si_ci95_pct"]);
    EXPECT_EQ(curves["si"]["p5"][i], rows[i]["si_p5_pct"]);
    EXPECT_EQ(curves["si"]["p95"][i], rows[i]["si_p95_pct"]);
    EXPECT_EQ(curves["rhe"]["mean"][i], rows[i]["rhe_pct"]);
    EXPECT_EQ(curves["rhe"]["ci95"][i], rows[i]["rhe_ci95_pct"]);
    EXPECT_LE(rows[i]["si_p5_pct"], rows[i]["si_pct"]);
    EXPECT_GE(rows[i]["si_p95_pct"], rows[i]["si_pct"]);
  }
}

TEST(ReportVerbTest, PutsTheRunWithoutTradedControlFirstWhateverTheOrderOfLogs) {
  const ScratchFolder folder;
  const auto log = [&](const std::string& name, const std::string& override) {
    return Log(folder, name, {"--set", override});
  };
  const Outcome report =
      Report({log("a.lcm", "/arbitrator/threshold=0.8"), log("b.lcm", "/arbitrator/threshold=0.2"),
              log("c.lcm", "/arbitrator/policy=none"), "--output", folder.File("report.html")});
  ASSERT_EQ(report.code, 0) << report.err;
  const nlohmann::json runs = DataOf(Content(folder.File("report.html")))["runs"];
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0]["name"], "without traded control");
  EXPECT_EQ(runs[1]["name"], "threshold 0.8");
  EXPECT_EQ(runs[2]["name"], "threshold 0.2");
}

TEST(ReportVerbTest, TellsRunsOfSeveralSeedsAndEqualOnesApart) {
  const ScratchFolder folder;
  const std::string page = folder.File("report.html");
  const Outcome report = Report({Log(folder, "none.lcm", {"--set", "/arbitrator/policy=none"}),
                                 Log(folder, "a.lcm", {}), Log(folder, "b.lcm", {}),
                                 Log(folder, "c.lcm", {"--seed", "2"}), "-o", page});
  ASSERT_EQ(report.code, 0) << report.err;
  const nlohmann::json runs = DataOf(Content(page))["runs"];
  EXPECT_EQ(runs[0]["name"], "without traded control, seed 1");
  EXPECT_EQ(runs[1]["name"], "threshold 0.5, seed 1, a.lcm");
  EXPECT_EQ(runs[2]["name"], "threshold 0.5, seed 1, b.lcm");
  EXPECT_EQ(runs[3]["name"], "threshold 0.5, seed 2");
  EXPECT_THAT(Content(page), HasSubstr("<span class=\"origin\">a.lcm · Traded control in fog"));
  EXPECT_THAT(Content(page), HasSubstr(">Seed</th>"));
}

TEST(ReportVerbTest, TellsEquallyNamedLogsOfTwoFoldersApart) {
  const ScratchFolder before;
  const ScratchFolder after;
  const std::string page = before.File("report.html");
  const Outcome report = Report({Log(before, "x.lcm", {}), Log(after, "x.lcm", {}), "-o", page});
  ASSERT_EQ(report.code, 0) << report.err;
  const nlohmann::json runs = DataOf(Content(page))["runs"];
  EXPECT_EQ(runs[0]["name"], "threshold 0.5, x.lcm, " + FolderOf(before));
  EXPECT_EQ(runs[1]["name"], "threshold 0.5, x.lcm, " + FolderOf(after));
}

TEST(ReportVerbTest, WritesThePageOfALogThatIsCutOffMarksItThereAndExitsWith1) {
  // GIVEN a whole log, and a log that is cut off
  const ScratchFolder folder;
  const std::string whole = Log(folder, "whole.lcm", {"--set", "/arbitrator/policy=none"});
  const std::string cut = Log(folder, "cut.lcm", {});
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) / 2);
  const std::string page = folder.File("report.html");
  const Outcome report = Report({whole, cut, "--output", page});
  // THEN the page is written, and the exit code says that a check failed
  EXPECT_EQ(report.code, 1);
  EXPECT_EQ(report.out, page + "\n");
  // AND stderr names the missing part of the log
  EXPECT_THAT(report.err, ContainsRegex(cut + ": cut off after event [^;]*; .*; ends after step "
                                              "[0-9]+ of 220"));
  // AND the page reports the missing part only for the cut run
  const nlohmann::json runs = DataOf(Content(page))["runs"];
  EXPECT_EQ(runs[0]["badge"], "");
  const std::string badge = runs[1]["badge"];
  EXPECT_THAT(badge, ContainsRegex("^incomplete: ends after step [0-9]+ of 220$"));
  EXPECT_THAT(Content(page), HasSubstr(">" + badge + "</span>"));
  EXPECT_THAT(Content(page), ContainsRegex("<span class=\"origin\">cut off after event [^<]*; ends "
                                           "after step [0-9]+ of 220"));
  // AND a page of the whole log alone succeeds
  EXPECT_EQ(Report({whole, "--output", page}).code, 0);
}

TEST(ReportVerbTest, ReplacesAPageAndNoOtherFile) {
  const ScratchFolder folder;
  const std::string log = Log(folder, "run.lcm", {});
  const std::string page = folder.File("report.html");
  EXPECT_EQ(Report({log, "-o", page}).code, 0);
  EXPECT_EQ(Report({log, "-o", page}).code, 0) << "the page of before";
  std::ofstream(folder.File("drawing.svg")) << "<svg></svg>";
  for (const std::string& other : {log, folder.File("drawing.svg")}) {
    const std::string before = Content(other);
    const Outcome report = Report({log, "-o", other});
    EXPECT_EQ(report.code, 2);
    EXPECT_EQ(report.err,
              other + ": error: --output: the file is no HTML page and is not replaced\n");
    EXPECT_EQ(Content(other), before);
  }
}

TEST(ReportVerbTest, RefusesWhatGivesNoReport) {
  const auto error_of = [](const std::vector<std::string>& arguments) {
    const Outcome outcome = Report(arguments);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_THAT(error_of({}), StartsWith("fogline report: error: neither LOG nor --curves is given"));
  EXPECT_THAT(error_of({"--curves", "scenario/paper.json", "--thresholds", "0.2:0.8"}),
              StartsWith("fogline report: error: --thresholds 0.2:0.8: not first:last:count"));
  EXPECT_THAT(error_of({"--curves", "scenario/paper.json", "--seeds", "9:1"}),
              StartsWith("fogline report: error: --seeds 9:1: neither A:B"));
  EXPECT_THAT(error_of({"--curves", "scenario/paper.json", "--set", "/arbitrator/policy=none"}),
              HasSubstr("/arbitrator/policy is none, which uses no threshold"));
}

TEST(ReportVerbTest, TriesItsOutputsBeforeItComputes) {
  // GIVEN curves that would take minutes
  const auto error_of = [](std::vector<std::string> more) {
    more.insert(more.end(), {"--curves", "scenario/paper.json", "--seeds", "1:1000000"});
    const Outcome outcome = Report(more);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  const ScratchFolder folder;
  const std::string page = folder.File("report.html");
  EXPECT_EQ(error_of({"--output", "/proc/report.html"}),
            "/proc/report.html: error: --output: cannot write: No such file or directory\n");
  EXPECT_EQ(error_of({"--output", page, "--png", "/proc"}),
            "/proc: error: --png: cannot write: No such file or directory\n");
  EXPECT_EQ(error_of({"--output", page, "--svg", "/proc"}),
            "/proc: error: --svg: cannot write: No such file or directory\n");
  EXPECT_EQ(error_of({"--output", page, "--pdf", "/proc"}),
            "/proc: error: --pdf: cannot write: No such file or directory\n");
  EXPECT_FALSE(std::filesystem::exists(page));
}

TEST(ReportVerbTest, WritesTheFiguresAsPngSvgAndPdfIntoTheFoldersAskedFor) {
  const ScratchFolder folder;
  const Outcome report =
      Report({Log(folder, "run.lcm", {}), "-o", folder.File("report.html"), "--png",
              folder.File("pixels"), "--svg", folder.File("lines"), "--pdf", folder.File("lines")});
  EXPECT_EQ(report.code, 0) << report.err;
  EXPECT_THAT(Content(folder.File("pixels/figure-1-speeds.png")), StartsWith("\x89PNG"));
  EXPECT_THAT(Content(folder.File("lines/figure-1-speeds.svg")), HasSubstr("<svg"));
  EXPECT_THAT(Content(folder.File("lines/figure-1-speeds.pdf")), StartsWith("%PDF-"));
  const auto count = [](const std::string& path) {
    return std::distance(std::filesystem::directory_iterator(path), {});
  };
  EXPECT_EQ(count(folder.File("pixels")), 6);
  EXPECT_EQ(count(folder.File("lines")), 2 * 6);
}

TEST(ReportVerbTest, EndsOnCtrlCWithoutAPage) {
  // GIVEN a log that is cut off, and curves that would take minutes. The verb first prints that the
  // log is incomplete, so after this text the verb is at work
  const ScratchFolder folder;
  const std::string log = folder.File("cut.lcm");
  RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct", "--log",
              log, "--quiet"});
  std::filesystem::resize_file(log, std::filesystem::file_size(log) / 2);
  const std::string file = folder.File("report.html");
  Background report({Program("fogline"), "report", log, "--curves", "scenario/paper.json",
                     "--seeds", "1:1000000", "--output", file});
  ASSERT_TRUE(report.WaitForErr(log)) << report.Err();
  // WHEN a person presses Ctrl-C
  report.Signal(SIGINT);
  // THEN the report says that it was interrupted, and leaves no file
  EXPECT_EQ(report.Wait(), 130);
  EXPECT_THAT(report.Err(), HasSubstr("fogline report: interrupted"));
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace fogline::test
