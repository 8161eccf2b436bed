// Logs that lack messages, because the logger lost messages or began late, and logs of several
// runs. The verbs use the messages in the log, name the missing messages, and compute nothing from
// steps that lack a message.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/log/event_log.h"
#include "services/log/remains.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/wire.h"
#include "tests/integration/logs/gap_fixture.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Words = std::vector<std::string>;

std::vector<std::string> LinesOf(const std::string& file) {
  std::istringstream text(Content(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST_F(GapTest, MetricsAreThoseOfTheWholeLogIfTheMissingMessageIsOfNoMeasure) {
  const std::string log = WithoutOne("RADAR");
  const nlohmann::json whole = Json({"metrics", whole_}, 0)[0];
  const nlohmann::json gap = Json({"metrics", log}, 1)[0];
  EXPECT_EQ(gap["metrics"], whole["metrics"]);
  EXPECT_EQ(gap["complete"], false);
  EXPECT_EQ(gap["steps"], 499);
  EXPECT_EQ(gap["digest"], nullptr);
  EXPECT_EQ(gap["gaps"]["messages"], (nlohmann::json{{"RADAR", 1}}));
  EXPECT_EQ(gap["gaps"]["gaps"][0],
            (nlohmann::json{{"first_step", 394}, {"last_step", 394}, {"channels", {"RADAR"}}}));
  EXPECT_THAT(Fogline({"metrics", log}).err,
              HasSubstr("1 message of 1 step is missing (RADAR 1), first: step 394 lacks RADAR"));
}

TEST_F(GapTest, MetricsSayWhatIsUnknownBecauseOfAGap) {
  const std::string log = WithoutOne("HOST_COMMAND");
  const nlohmann::json whole = Json({"metrics", whole_}, 0)[0]["metrics"];
  const nlohmann::json gap = Json({"metrics", log}, 1)[0]["metrics"];
  for (const char* unknown : {"rhe_pct", "human_time_s", "transfers", "wrong_human_s"}) {
    EXPECT_FALSE(whole[unknown].is_null()) << unknown;
    EXPECT_TRUE(gap[unknown].is_null()) << unknown;
  }
  for (const char* known : {"min_host_gap_m", "max_abs_jerk_mps3", "rms_fusion_error_m"}) {
    EXPECT_EQ(gap[known], whole[known]) << known;
  }
  const Outcome text = Fogline({"metrics", log});
  EXPECT_THAT(text.err, HasSubstr("unknown, because messages are missing: "));
  EXPECT_THAT(text.out, HasSubstr("transfers                            unknown"));
}

TEST_F(GapTest, AMeasureIsUnknownIfTheLogHasNoMessageOfItsChannel) {
  const nlohmann::json whole = Json({"metrics", whole_}, 0)[0]["metrics"];
  const auto unknown_without = [&](std::string_view lost) {
    const std::string log =
        Without([&](std::string_view channel, std::int64_t) { return channel == lost; });
    const nlohmann::json metrics = Json({"metrics", log}, 1)[0]["metrics"];
    const std::string err = Fogline({"metrics", log}).err;
    for (const auto& [name, value] : metrics.items()) {
      const bool known = err.find(" " + name + ",") == std::string::npos &&
                         err.find(" " + name + ";") == std::string::npos;
      EXPECT_EQ(value, known ? whole[name] : nullptr) << name;
    }
    return metrics;
  };
  const nlohmann::json without_commands = unknown_without("HOST_COMMAND");
  for (const char* name : {"max_doc", "min_conflict_clear_m", "max_conflict_clear_m"}) {
    EXPECT_TRUE(without_commands[name].is_null()) << name;
  }
  EXPECT_TRUE(unknown_without("TRACK")["rms_fusion_error_m"].is_null());
  const nlohmann::json without_followers = unknown_without("FOLLOWER_COMMAND");
  EXPECT_TRUE(without_followers["max_compromised_safety_m"].is_null());
  EXPECT_EQ(without_followers["min_follower_gap_m"], whole["min_follower_gap_m"]);
}

TEST_F(GapTest, NoMeasureIsKnownWithoutAnyTruth) {
  const std::string log =
      Without([](std::string_view channel, std::int64_t) { return channel == "TRUTH"; });
  const nlohmann::json metrics = Json({"metrics", log}, 1)[0]["metrics"];
  EXPECT_GT(metrics.size(), 40U);
  for (const auto& [name, value] : metrics.items()) EXPECT_TRUE(value.is_null()) << name;
  EXPECT_THAT(Fogline({"metrics", log}).err,
              EndsWith(": unknown, because messages are missing: all measures\n"));
}

TEST_F(GapTest, TheSafetyImprovementIsUnknownIfOneOfTheTwoLogsHasAGap) {
  const std::string none = folder_.File("none.lcm");
  ASSERT_EQ(Fogline({"run", "scenario/paper.json", "--transport", "direct", "--quiet", "--log",
                     none, "--set", "/arbitrator/policy=none"})
                .code,
            0);
  EXPECT_FALSE(Json({"metrics", none, whole_}, 0)[1]["si_pct"].is_null());
  const std::string log = WithoutOne("TRUTH");
  EXPECT_TRUE(Json({"metrics", none, log}, 1)[1]["si_pct"].is_null());
  EXPECT_THAT(Fogline({"metrics", none, log}).err, HasSubstr("si_pct"));
  std::filesystem::resize_file(none, std::filesystem::file_size(none) / 2);
  EXPECT_TRUE(Json({"metrics", none, whole_}, 1)[1]["si_pct"].is_null());
  EXPECT_THAT(Fogline({"metrics", none, whole_}).err,
              AllOf(HasSubstr(none + ": the measures are of the steps in the log\n"),
                    HasSubstr(whole_ + ": unknown, because messages are missing: si_pct, ")));
}

TEST_F(GapTest, EventsGoOnAfterAGapAndShowIt) {
  const std::string log = Without([](std::string_view channel, std::int64_t step) {
    return channel == "HOST_COMMAND" && step >= 394 && step <= 396;
  });
  const nlohmann::json whole = Json({"events", whole_}, 0)[0];
  const nlohmann::json gap = Json({"events", log}, 1)[0];
  EXPECT_EQ(gap["events"], whole["events"]);
  EXPECT_EQ(gap["gaps"]["gaps"][0]["last_step"], 396);
  const Outcome text = Fogline({"events", log});
  EXPECT_THAT(text.out, HasSubstr("     394     39.40 s  unknown: steps 394 to 396 lack "
                                  "HOST_COMMAND\n"));
}

TEST_F(GapTest, ExportHasARowWithEmptyCellsForAMissingMessage) {
  const std::string log = WithoutOne("RADAR");
  const std::string out = folder_.File("csv");
  const std::string out_of_whole = folder_.File("csv_of_whole");
  const Outcome outcome = Fogline({"export", log, "--out", out});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("step 394 lacks RADAR"));
  ASSERT_EQ(Fogline({"export", whole_, "--out", out_of_whole}).code, 0);
  for (const std::string channel : {"TRUTH", "HOST_COMMAND"}) {
    EXPECT_EQ(Content(out + "/" + channel + ".csv"),
              Content(out_of_whole + "/" + channel + ".csv"));
  }
  const std::vector<std::string> rows = LinesOf(out + "/RADAR.csv");
  std::vector<std::string> expected = LinesOf(out_of_whole + "/RADAR.csv");
  ASSERT_EQ(expected.size(), 501U);
  std::string& row = expected[395];
  // The first three cells are the header of the message: header.run_id, header.step and
  // header.utime. The export knows them, and leaves the other cells empty.
  std::size_t end = 0;
  for (int comma = 0; comma < 3; ++comma) end = row.find(',', end) + 1;
  const auto cells = std::count(row.begin() + static_cast<std::ptrdiff_t>(end), row.end(), ',');
  row = row.substr(0, end) + std::string(static_cast<std::size_t>(cells), ',');
  EXPECT_EQ(rows, expected);
}

TEST_F(GapTest, ExportHasRowsOfAChannelWithoutAnyMessage) {
  const std::string log =
      Without([](std::string_view channel, std::int64_t) { return channel == "RADAR"; });
  const std::string out = folder_.File("csv");
  EXPECT_EQ(Fogline({"export", log, "--out", out}).code, 1);
  const std::vector<std::string> rows = LinesOf(out + "/RADAR.csv");
  ASSERT_EQ(rows.size(), 501U);
  EXPECT_THAT(rows[395], HasSubstr(",394,39400000,,"));
  EXPECT_EQ(Fogline({"export", log, "--out", folder_.File("log.mat")}).code, 1);
}

TEST_F(GapTest, ALogWithoutTheBeginningIsUsedFromItsFirstStepOn) {
  const std::string log = Without(
      [](std::string_view channel, std::int64_t step) { return channel != "RUN" && step < 124; });
  const nlohmann::json metrics = Json({"metrics", log}, 1)[0];
  EXPECT_EQ(metrics["steps"], 376);
  EXPECT_EQ(metrics["gaps"]["first_step"], 124);
  EXPECT_NEAR(metrics["metrics"]["duration_s"], 37.5, 1e-9);
  EXPECT_THAT(Fogline({"metrics", log}).err, HasSubstr("begins at step 124 of 500"));
  const std::string out = folder_.File("csv");
  EXPECT_EQ(Fogline({"export", log, "--out", out}).code, 1);
  EXPECT_EQ(LinesOf(out + "/TRUTH.csv").size(), 377U);
}

TEST_F(GapTest, ALogWithoutAScenarioIsExportedAndMeasuredWithAGivenScenario) {
  const std::string log = Without(
      [](std::string_view channel, std::int64_t step) { return channel == "RUN" || step < 124; });
  const std::string out = folder_.File("csv");
  const Outcome exported = Fogline({"export", log, "--out", out});
  EXPECT_EQ(exported.code, 1);
  EXPECT_THAT(exported.err, HasSubstr("the log has no scenario; begins at step 124"));
  EXPECT_EQ(LinesOf(out + "/LIDAR.csv").size(), 377U);
  EXPECT_FALSE(std::filesystem::exists(out + "/scenario.json"));
  const Outcome refused = Fogline({"metrics", log});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--scenario FILE gives it"));
  const nlohmann::json given = Json({"metrics", log, "--scenario", "scenario/paper.json"}, 1)[0];
  EXPECT_EQ(given["steps"], 376);
  EXPECT_EQ(given["title"], Json({"metrics", whole_}, 0)[0]["title"]);
  EXPECT_THAT(
      Fogline({"metrics", log, "--scenario", "scenario/paper.json"}).err,
      HasSubstr(": --scenario is not checked, because the log has no hash; begins at step 124"));
  EXPECT_THAT(Fogline({"metrics", whole_, "--scenario", "scenario/paper.json"}).err,
              Not(HasSubstr("not checked")));
}

TEST_F(GapTest, ExportHasARowForEachStepOfALogThatIsCutOff) {
  // GIVEN the log of a killed run: the world is ahead of the other roles
  const std::string log = Without([](std::string_view channel, std::int64_t step) {
    return channel != "RUN" && (channel == "TRUTH" ? step > 102 : step > 100);
  });
  const std::string out = folder_.File("csv");
  EXPECT_EQ(Fogline({"export", log, "--out", out}).code, 1);
  const std::vector<std::string> truth = LinesOf(out + "/TRUTH.csv");
  const std::vector<std::string> lidar = LinesOf(out + "/LIDAR.csv");
  ASSERT_EQ(truth.size(), 104U);
  ASSERT_EQ(lidar.size(), 104U);
  const auto header = [](const std::string& line) {
    std::size_t end = 0;
    for (int comma = 0; comma < 3; ++comma) end = line.find(',', end) + 1;
    return line.substr(0, end);
  };
  for (const std::size_t row : {102U, 103U}) {
    EXPECT_EQ(header(lidar[row]), header(truth[row]));
    EXPECT_EQ(lidar[row].find_first_not_of(',', header(lidar[row]).size()), std::string::npos);
  }
  EXPECT_THAT(Fogline({"metrics", log}).err,
              HasSubstr("ends after step 100 of 500; step 101 lacks"));
}

TEST_F(GapTest, AnMcapFileOfALogWithGapsHasNoDigest) {
  const std::string file = folder_.File("run.mcap");
  EXPECT_EQ(Fogline({"export", WithoutOne("RADAR"), "--mcap", file}).code, 1);
  // In a map of an MCAP file, the length of each text comes before the text.
  EXPECT_THAT(Content(file), HasSubstr(std::string("digest\x07\0\0\0unknown", 17)));
}

TEST_F(GapTest, AScenarioThatTheLogContradictsIsRefused) {
  const Outcome outcome = Fogline({"metrics", whole_, "--scenario", "scenario/dense_fog.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--scenario: the log is of another scenario: its hash is "));
}

TEST_F(GapTest, ALogOfSeveralRunsNamesThemAndIsReadForTheChosenOne) {
  const std::string other = folder_.File("other.lcm");
  ASSERT_EQ(Fogline({"run", "scenario/paper.json", "--transport", "direct", "--quiet", "--log",
                     other, "--seed", "2"})
                .code,
            0);
  const std::string both = folder_.File("both.lcm");
  std::ofstream(both, std::ios::binary) << Content(whole_) << Content(other);
  const std::int64_t first = log::ReadFront(whole_).run_id;
  const std::int64_t second = log::ReadFront(other).run_id;
  const Outcome digest = Fogline({"digest", both});
  EXPECT_THAT(digest.err, HasSubstr("this is run " + std::to_string(first) +
                                    "; the log also has run " + std::to_string(second)));
  const std::string whole = Fogline({"digest", whole_}).out;
  EXPECT_THAT(digest.out, StartsWith(whole.substr(0, whole.find(' '))));
  const std::string chosen = Fogline({"digest", other}).out;
  const Outcome of_second = Fogline({"digest", both, "--run", std::to_string(second)});
  EXPECT_THAT(of_second.out, StartsWith(chosen.substr(0, chosen.find(' '))));
  const nlohmann::json metrics = Json({"metrics", both, "--run", std::to_string(second)}, 0)[0];
  EXPECT_EQ(metrics["metrics"], Json({"metrics", other}, 0)[0]["metrics"]);
  const Outcome equal = Fogline({"diff", both, other, "--run-a", std::to_string(second)});
  EXPECT_EQ(equal.code, 0) << equal.out << equal.err;
  const Outcome differ = Fogline({"diff", both, both, "--run-b", std::to_string(second)});
  EXPECT_EQ(differ.code, 1);
  EXPECT_THAT(differ.out, HasSubstr(" in " + both + ", "));
  EXPECT_THAT(differ.out, HasSubstr(" in run " + std::to_string(second) + " of " + both + "\n"));
  EXPECT_EQ(Fogline({"diff", both, both, "--run-b", "5"}).code, 2);
  const Outcome unknown = Fogline({"metrics", both, "--run", "5"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("the log has no run 5; it has "));
}

TEST_F(GapTest, ALogThatBeginsLateSaysWithItsDigestWithWhichStep) {
  // GIVEN a log without the first steps of its run. In this log RUN comes after the messages of
  // steps 196 to 198
  const std::string late = folder_.File("late.lcm");
  {
    log::EventLogReader reader(whole_);
    log::EventLogWriter writer(late);
    std::vector<log::Event> runs;
    while (const auto event = reader.Next()) {
      const std::int64_t step = runtime::ReadInt64(event->data, runtime::kStepOffset);
      if (event->channel == ChannelOf<run_t>().name) runs.push_back(*event);
      if (step < 196 || event->channel == "FOGLINE_SEAL") continue;
      if (step == 199) {
        for (const log::Event& run : runs) writer.Write(run.channel, run.utime, run.data);
        runs.clear();
      }
      writer.Write(event->channel, event->utime, event->data);
    }
  }
  const Outcome digest = Fogline({"digest", late});
  EXPECT_EQ(digest.code, 1);
  EXPECT_EQ(digest.err,
            late +
                ": begins at step 196 of 500; the messages before RUN are not read; no step "
                "is read\n");
  EXPECT_THAT(Fogline({"metrics", late}).err, HasSubstr(": begins at step 196 of 500"));
  EXPECT_EQ(digest.out, "unknown  " + late + "\n");
  EXPECT_EQ(Json({"digest", late}, 1)[0]["digest"], nullptr);
  // Other verbs that read only whole steps compare nothing.
  const Outcome replay = Fogline({"replay", late, "--role", "driver"});
  EXPECT_EQ(replay.code, 1);
  EXPECT_EQ(replay.out, "driver      unknown: no step is compared\n");
  EXPECT_EQ(Json({"replay", late, "--role", "driver"}, 1)["same"], nullptr);
  for (const std::string& other : {late, whole_}) {
    const Outcome differ = Fogline({"diff", late, other});
    EXPECT_EQ(differ.code, 1);
    EXPECT_EQ(differ.out, "unknown: no step is compared\n");
    EXPECT_EQ(Json({"diff", other, late}, 1)["equal"], nullptr);
  }
}

TEST_F(GapTest, AVerbThatReadsOnlyWholeStepsSaysUpToWhichStepTheyGo) {
  const std::string log = WithoutOne("RADAR");
  const std::string note = ": complete up to step 393 of 500; step 394 lacks RADAR\n";
  EXPECT_EQ(Fogline({"digest", log}).err, log + note);
  EXPECT_THAT(Fogline({"replay", log, "--role", "driver"}).err, HasSubstr(note));
  const Outcome differ = Fogline({"diff", whole_, log});
  EXPECT_EQ(differ.code, 1);
  EXPECT_THAT(differ.out, StartsWith("step 394: (run) (step): there in "));
  EXPECT_EQ(differ.err, log + note);
  const std::string first = Without(
      [](std::string_view channel, std::int64_t step) { return channel == "RADAR" && step == 0; });
  EXPECT_EQ(Fogline({"digest", first}).err, first + ": no step is read; step 0 lacks RADAR\n");
}

TEST_F(GapTest, AMeasureWithoutAValueIsUnknownIfAGapMayHideTheValue) {
  std::int64_t fog = 500;
  log::EventLogReader reader(whole_);
  truth_t truth{};
  while (const auto event = reader.Next()) {
    if (event->channel != "TRUTH" || !runtime::Decode(event->data, truth)) continue;
    if (truth.fog_present != 0) fog = std::min(fog, truth.header.step);
  }
  const std::string log = Without([&](std::string_view channel, std::int64_t step) {
    return channel == "FOLLOWER_COMMAND" && step >= fog;
  });
  const nlohmann::json metrics = Json({"metrics", log}, 1)[0]["metrics"];
  EXPECT_TRUE(metrics["mean_compromised_safety_fog_m"].is_null());
  EXPECT_THAT(Fogline({"metrics", log}).err, HasSubstr(" mean_compromised_safety_fog_m,"));
}

TEST_F(GapTest, TheReportOfALogWithAGapLeavesOutWhatIsUnknown) {
  const std::string log = WithoutOne("HOST_COMMAND");
  const std::string page = folder_.File("report.html");
  const Outcome outcome = Fogline({"report", log, "--output", page});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("step 394 lacks HOST_COMMAND"));
  EXPECT_THAT(outcome.err, HasSubstr("unknown, because messages are missing: rhe_pct, "));
  EXPECT_THAT(Content(page), Not(HasSubstr("Human drives")));
}

TEST_F(GapTest, AFileOfLcmLoggerThatBeganInTheMiddleOfARunIsUsed) {
  // GIVEN a run that is under way
  runtime::Bus bus(runtime::FreshMulticastUrl());
  std::int64_t step = -1;
  bus.Subscribe("TRUTH", [&step](runtime::Bytes truth) {
    step = runtime::ReadInt64(truth, runtime::kStepOffset);
  });
  Background driver({Program("fogline-driver"), "--lcm-url", bus.url()});
  Background run({Program("fogline"), "run", "scenario/paper.json", "--quiet", "--pace", "5",
                  "--set", "/steps=300", "--external", "driver", "--stall-timeout", "100", "--log",
                  folder_.File("own.lcm"), "--lcm-url", bus.url()});
  const TimePoint end = Clock::now() + kPatience;
  while (step < 40 && Clock::now() < end) bus.Wait(milliseconds(10));
  ASSERT_GE(step, 40);
  // WHEN lcm-logger joins while the run waits for its driver, and the run ends
  driver.Signal(SIGSTOP);
  const std::string log = folder_.File("late.lcm");
  Background logger(
      {"lcm-logger", "--quiet", "--flush-interval=10", "--lcm-url=" + bus.url(), log});
  const auto publish_until_logged = [&](const std::string& channel) {
    while (Content(log).find(channel) == std::string::npos && Clock::now() < end) {
      bus.Publish(channel, std::vector<std::uint8_t>(runtime::kHeaderEnd));
      bus.Wait(milliseconds(10));
    }
  };
  publish_until_logged("DURING_RUN");
  driver.Signal(SIGCONT);
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  publish_until_logged("AFTER_RUN");
  logger.Signal(SIGINT);
  ASSERT_EQ(logger.Wait(), 0);
  // THEN the verbs show the steps that the log has. lcm-logger may have lost some messages of these
  // steps.
  const std::string scenario = folder_.File("effective.json");
  std::ofstream(scenario)
      << Fogline({"check", "scenario/paper.json", "--print", "--set", "/steps=300"}).out;
  const nlohmann::json metrics = Json({"metrics", log, "--scenario", scenario}, 1)[0];
  EXPECT_GT(metrics["steps"], 0);
  EXPECT_GE(metrics["gaps"]["first_step"], 40);
  const std::string out = folder_.File("csv");
  EXPECT_EQ(Fogline({"export", log, "--out", out}).code, 1);
  EXPECT_GT(LinesOf(out + "/TRUTH.csv").size(), 1U);
}

}  // namespace
}  // namespace fogline::test
