// Whole experiments with the real programs: every trial is a run in real time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "services/log/event_log.h"
#include "services/log/log_seal.h"
#include "services/runtime/wire/wire.h"
#include "tests/integration/experiment/experiment_fixture.h"
#include "tests/integration/experiment/page_session.h"
#include "tests/support/command.h"
#include "tests/support/web_client.h"

namespace fogline::test {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class ExperimentRealtimeTest : public ExperimentFixture {};

TEST_F(ExperimentRealtimeTest, ASessionThatIsKilledInARunLosesNothing) {
  ASSERT_EQ(RunCommand(Session(1)).code, 0);
  {
    // Participant 2: the second run is killed while it is under way.
    Background session(Session(2, 1, "--speed 1"));  // slow, so that the kill comes in time
    const std::string log = results_ + "/participant-02/trial-2-high.lcm";
    // The test waits until the recorder has written the beginning of the trial (a TRIAL message)
    // into the log. With an earlier kill, the log might never get this message.
    ASSERT_TRUE(ComesToHave("TRIAL", log)) << session.Err();
    session.Signal(SIGKILL);
    session.Wait();
  }
  const std::string first = Content(results_ + "/participant-02/trial-1-mid.lcm");
  const std::string broken = Content(results_ + "/participant-02/trial-2-high.lcm");
  const Outcome status = Experiment("status");
  EXPECT_EQ(status.code, 1);
  EXPECT_THAT(status.out, HasSubstr("broken"));
  EXPECT_THAT(status.out, HasSubstr("4 of 12 trials"));

  // The same command continues with the run that was killed.
  const Outcome resumed = RunCommand(Session(2, 2));
  ASSERT_EQ(resumed.code, 0) << resumed.err << resumed.out;
  EXPECT_EQ(Content(results_ + "/participant-02/trial-1-mid.lcm"), first);
  EXPECT_EQ(Content(results_ + "/participant-02/trial-2-high.lcm"), broken);
  EXPECT_THAT(Content(results_ + "/participant-02/trial-2-high-attempt-2.lcm"),
              SizeIs(::testing::Gt(0U)));
  for (int participant = 3; participant <= kParticipants; ++participant) {
    const Outcome session = RunCommand(Session(participant));
    ASSERT_EQ(session.code, 0) << session.err;
  }
  EXPECT_EQ(Experiment("status").code, 0);

  const auto rows = ExportedTrials();
  ASSERT_THAT(rows, SizeIs(12));
  std::map<int, std::set<std::string>> by_participant;
  std::map<int, std::set<std::string>> by_place;
  std::set<std::string> seeds;
  for (const auto& row : rows) {
    const int participant = std::stoi(row.at("participant"));
    const int trial = std::stoi(row.at("trial"));
    by_participant[participant].insert(row.at("condition"));
    if (participant <= 3) by_place[trial].insert(row.at("condition"));
    seeds.insert(row.at("seed"));
    EXPECT_EQ(row.at("state"), "done");
    EXPECT_EQ(row.at("tlx.mental_demand"), std::to_string(5 * (participant + trial)));
    EXPECT_EQ(row.at("tlx.frustration"), std::to_string(5 * (participant + trial + 5)));
    EXPECT_EQ(row.at("kss.sleepiness"), std::to_string(participant + trial));
    EXPECT_NEAR(std::stod(row.at("duration_s")), 7.9, 1e-9);
    EXPECT_EQ(row.at("attempt"), participant == 2 && trial == 2 ? "2" : "1");
  }
  // Each participant drives each condition once. The first three participants form a Latin square:
  // each condition is once at each place of the order.
  ASSERT_THAT(by_participant, SizeIs(4));
  for (const auto& [participant, conditions] : by_participant) EXPECT_THAT(conditions, SizeIs(3));
  for (const auto& [place, conditions] : by_place) EXPECT_THAT(conditions, SizeIs(3));
  EXPECT_THAT(seeds, SizeIs(12));
}

/// Makes all trials: begins each run, sets a marker in it, and answers each question.
/// @param kill_in the run in which fogline-web is killed; 0: none
void MakeTrials(PageSession& session, int participant, int kill_in) {
  std::int64_t answered = -1;
  for (;;) {
    const auto state = session.NextState(answered);
    answered = state["state"];
    const int run = state["run"];
    if (state["stage"] == "waiting" && state["wait_s"] == 0) session.Begin(state);
    if (state["stage"] == "driving") {
      session.experimenter().Send(
          nlohmann::json{{"op", "marker"}, {"text", fmt::format("note {}", run)}}.dump());
      if (run == kill_in) session.KillView();
    }
    if (state["stage"] == "asking") session.Answer(state, participant + run);
    if (state["stage"] == "finished") return;
  }
}

TEST_F(ExperimentRealtimeTest, AKillOfFoglineWebInARunLosesNothingOfAnExperimentInPages) {
  for (int participant = 1; participant <= kParticipants; ++participant) {
    // At this speed no run is over before the test has sent the marker.
    PageSession session({Program("fogline"), "experiment", "run", file_, "--results", results_,
                         "--participant", std::to_string(participant), "--speed", "1"});
    MakeTrials(session, participant, participant == 2 ? 2 : 0);
    EXPECT_EQ(session.process().Wait(), 0) << session.process().Err();
    const bool was_killed =
        session.process().Err().find("fogline-web was killed") != std::string::npos ||
        session.process().Err().find("it is started again") != std::string::npos;
    EXPECT_EQ(was_killed, participant == 2) << session.process().Err();
  }
  EXPECT_EQ(Experiment("status").code, 0);
  const auto rows = ExportedTrials();
  ASSERT_THAT(rows, SizeIs(12));
  for (const auto& row : rows) {
    const int sum = std::stoi(row.at("participant")) + std::stoi(row.at("trial"));
    EXPECT_EQ(row.at("state"), "done");
    EXPECT_EQ(row.at("attempt"), "1");
    EXPECT_EQ(row.at("markers"), "1");
    EXPECT_EQ(row.at("tlx.effort"), std::to_string(5 * (sum + 4)));
    EXPECT_EQ(row.at("kss.sleepiness"), std::to_string(sum));
  }
  EXPECT_THAT(Content(folder_.File("tables") + "/values.csv"),
              HasSubstr(",marker,marker,note 2,,"));
}

TEST_F(ExperimentRealtimeTest, ThePagesShowOnlyWhatIsMeantForThem) {
  PageSession session({Program("fogline"), "experiment", "run", file_, "--results", results_,
                       "--participant", "1"});
  // Each page needs its own token, and neither server has the files of the other page.
  EXPECT_NE(session.participant_token(), session.experimenter_token());
  const auto open = [](std::uint16_t port, const std::string& token) {
    return WebClient(port, {.target = PageSession::SocketTarget(token), .protocol = ""});
  };
  for (const std::uint16_t port : {session.participant_port(), session.experimenter_port()}) {
    EXPECT_THROW(open(port, ""), WebRefused);
  }
  EXPECT_THROW(open(session.experimenter_port(), session.participant_token()), WebRefused);
  EXPECT_THROW(open(session.participant_port(), session.experimenter_token()), WebRefused);
  const auto status = [](std::uint16_t port, const std::string& target) {
    return StatusOf(Exchange(port, GetRequest(port, target)));
  };
  EXPECT_EQ(status(session.participant_port(), "/"), 200);
  EXPECT_EQ(status(session.participant_port(), "/participant.js"), 200);
  EXPECT_EQ(status(session.participant_port(), "/experimenter.js"), 404);
  EXPECT_EQ(status(session.experimenter_port(), "/experimenter.js"), 200);
  EXPECT_EQ(status(session.experimenter_port(), "/participant.js"), 404);
  WebClient participant = open(session.participant_port(), session.participant_token());
  // The first state can come before the session is ready for the run, so the test waits for the
  // state "waiting".
  std::string state;
  while (state.find("waiting") == std::string::npos) {
    state = participant.Receive().bytes;
    EXPECT_THAT(state, ::testing::Not(HasSubstr("low")));
  }
  session.process().Signal(SIGINT);
  EXPECT_EQ(session.process().Wait(), 130);
}

TEST_F(ExperimentRealtimeTest, AnswersThatAreMissingAreAskedWithoutAnotherRun) {
  // The answers end after the first questionnaire of run 1.
  const std::string input = folder_.File("short.txt");
  std::ofstream(input) << "\n10\n20\n30\n40\n50\n60\n";
  const Outcome cut = RunCommand(
      {"sh", "-c",
       fmt::format("exec {} experiment run {} --results {} --participant 1 --no-page < {}",
                   Program("fogline"), file_, results_, input)});
  EXPECT_EQ(cut.code, 3);
  EXPECT_THAT(cut.err, HasSubstr("the same command continues from here"));
  const Outcome status = Experiment("status");
  EXPECT_THAT(status.out, HasSubstr("to_ask"));
  // The new answers begin with the sleepiness of run 1. The answers of runs 2 and 3 follow.
  std::ofstream(input) << "7\n" << AnswersOf(1, 2) << AnswersOf(1, 3);
  const Outcome resumed = RunCommand(
      {"sh", "-c",
       fmt::format("exec {} experiment run {} --results {} --participant 1 --no-page < {}",
                   Program("fogline"), file_, results_, input)});
  ASSERT_EQ(resumed.code, 0) << resumed.err << resumed.out;
  EXPECT_THAT(resumed.out, HasSubstr("2 runs now"));
  const Outcome exported = Experiment("export", {"--out", folder_.File("tables")});
  EXPECT_EQ(exported.code, 1);  // the other participants have not begun
  const std::string values = Content(folder_.File("tables") + "/values.csv");
  EXPECT_THAT(values, AllOf(HasSubstr("1,1,0,low,answer,tlx.mental_demand,10,,\n"),
                            HasSubstr("1,1,0,low,answer,kss.sleepiness,7,,\n"),
                            HasSubstr("metric,min_host_gap_m,")));
}

TEST_F(ExperimentRealtimeTest, QuestionsOfASessionThatGoesOnAreThoseOfTheirRun) {
  // The answers end after run 1 and the first questionnaire of run 2.
  const std::string input = folder_.File("short.txt");
  std::ofstream(input) << AnswersOf(3, 1) << "\n10\n20\n30\n40\n50\n60\n";
  const Outcome cut = RunCommand(
      {"sh", "-c",
       fmt::format("exec {} experiment run {} --results {} --participant 3 --no-page < {}",
                   Program("fogline"), file_, results_, input)});
  EXPECT_EQ(cut.code, 3) << cut.err;
  PageSession session({Program("fogline"), "experiment", "run", file_, "--results", results_,
                       "--participant", "3"});
  nlohmann::json state;
  while (state["stage"] != "asking")
    state = nlohmann::json::parse(session.experimenter().Receive().bytes);
  EXPECT_EQ(state["participant"], 3);
  EXPECT_EQ(state["run"], 2);
  EXPECT_EQ(state["of"], 3);
  EXPECT_THAT(state["condition"].get<std::string>(), HasSubstr(", seed "));
  session.process().Signal(SIGINT);
  EXPECT_EQ(session.process().Wait(), 130);
}

TEST_F(ExperimentRealtimeTest, TheLogOfATrialTellsItsStory) {
  ASSERT_EQ(RunCommand(Session(1)).code, 0);
  const std::string log = results_ + "/participant-01/trial-1-low.lcm";
  const Outcome exported =
      RunCommand({Program("fogline"), "export", log, "--out", folder_.File("csv")});
  EXPECT_EQ(exported.code, 0) << exported.err;
  const Outcome metrics = RunCommand({Program("fogline"), "metrics", log});
  EXPECT_EQ(metrics.code, 0) << metrics.err;
  EXPECT_THAT(Content(log), AllOf(HasSubstr("TRIAL"), HasSubstr("mental_demand")));
}

TEST_F(ExperimentRealtimeTest, AMeasureThatMissingMessagesMakeUnknownHasNoValue) {
  ASSERT_EQ(RunCommand(Session(1)).code, 0);
  const std::map<std::string, std::string> whole = ExportedTrials(1).at(0);
  EXPECT_EQ(whole.at("complete"), "1");
  EXPECT_NE(whole.at("human_time_s"), "");
  const std::string log = results_ + "/" + whole.at("log");
  const std::string part = folder_.File("part.lcm");
  {
    log::EventLogReader reader(log);
    log::EventLogWriter writer(part);
    while (const auto event = reader.Next()) {
      const std::int64_t step = runtime::ReadInt64(event->data, runtime::kStepOffset);
      // The log loses the commands of 41 steps. So even an old STATUS of the arbitrator shows that
      // the arbitrator has published more commands than the log has.
      const bool lost = event->channel == "HOST_COMMAND" && step >= 20 && step <= 60;
      if (lost || event->channel == log::kLogSealChannel) continue;
      writer.Write(event->channel, event->utime, event->data);
    }
  }
  std::filesystem::rename(part, log);
  const std::map<std::string, std::string> row = ExportedTrials(1).at(0);
  EXPECT_EQ(row.at("complete"), "0");
  EXPECT_EQ(row.at("human_time_s"), "");
  EXPECT_EQ(row.at("min_host_gap_m"), whole.at("min_host_gap_m"));
}

TEST_F(ExperimentRealtimeTest, ALogThatHasLostItsFactsIsKnownByItsScenario) {
  // GIVEN two complete logs without the facts of their trials (TRIAL messages), as after a crash.
  // The test then exchanges their file names
  ASSERT_EQ(RunCommand(Session(1)).code, 0);
  const std::filesystem::path own = std::filesystem::path(results_) / "participant-01";
  const std::string first = (own / "trial-1-low.lcm").string();
  const std::string second = (own / "trial-2-mid.lcm").string();
  for (const std::string& log : {first, second}) {
    const std::string part = folder_.File("part.lcm");
    {
      log::EventLogReader reader(log);
      log::EventLogWriter writer(part);
      while (const auto event = reader.Next()) {
        if (event->channel == "TRIAL" || event->channel == log::kLogSealChannel) continue;
        writer.Write(event->channel, event->utime, event->data);
      }
    }
    std::filesystem::rename(part, log);
  }
  const auto states = [this] {
    std::vector<std::string> found;
    const auto status = nlohmann::json::parse(Experiment("status", {"--json"}).out);
    for (const auto& trial : status["participants"][0]["trials"]) found.push_back(trial["state"]);
    return found;
  };
  EXPECT_THAT(states(), ElementsAre("to_ask", "to_ask", "done"));
  std::filesystem::rename(first, folder_.File("low.lcm"));
  std::filesystem::rename(second, first);
  std::filesystem::rename(folder_.File("low.lcm"), second);
  EXPECT_THAT(states(), ElementsAre("broken", "broken", "done"));
  // WHEN each log has its own name again, THEN the questions of its run are asked, and its facts
  // have the seed of its run
  std::filesystem::rename(first, folder_.File("mid.lcm"));
  std::filesystem::rename(second, first);
  std::filesystem::rename(folder_.File("mid.lcm"), second);
  const std::string answers = folder_.File("answers.txt");
  for (int run : {1, 2}) std::ofstream(answers, std::ios::app) << AnswersOf(1, run).substr(1);
  const Outcome again = RunCommand(
      {"sh", "-c",
       fmt::format("exec {} experiment run {} --results {} --participant 1 --no-page < {}",
                   Program("fogline"), file_, results_, answers)});
  EXPECT_EQ(again.code, 0) << again.err;
  const auto rows = ExportedTrials(1);
  ASSERT_THAT(rows, SizeIs(3));
  EXPECT_EQ(rows[1].at("seed"), "2");
  log::EventLogReader reader(second);
  std::vector<std::int64_t> seeds;
  while (const auto event = reader.Next()) {
    trial_t fact{};
    if (event->channel == "TRIAL" && runtime::Decode(event->data, fact)) seeds.push_back(fact.seed);
  }
  EXPECT_THAT(seeds, AllOf(SizeIs(8), Each(2)));  // seven answers and END
  EXPECT_EQ(rows[1].at("kss.sleepiness"), "3");
  EXPECT_EQ(rows[1].at("begun"), "") << "the log has no BEGIN";
}

TEST_F(ExperimentRealtimeTest, ALogOfAnotherTrialIsNotTakenForThisOne) {
  ASSERT_EQ(RunCommand(Session(1)).code, 0);
  // GIVEN a log under the name of another participant's trial, and the log of a run that is no
  // trial
  const std::filesystem::path other = std::filesystem::path(results_) / "participant-02";
  std::filesystem::create_directory(other);
  const std::filesystem::path own = std::filesystem::path(results_) / "participant-01";
  std::filesystem::copy_file(own / "trial-1-low.lcm", other / "trial-1-mid.lcm");
  ASSERT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--quiet", "--log",
                        (other / "trial-2-high.lcm").string()})
                .code,
            0);
  const Outcome status = Experiment("status");
  EXPECT_EQ(status.code, 1);
  EXPECT_THAT(status.out, AllOf(HasSubstr("3 of 12 trials"),
                                HasSubstr("the log is of trial 1 of participant 1 in condition "
                                          "\"low\""),
                                HasSubstr("the log has no facts of a trial")));
  // THEN the export names the two wrong logs of participant 2, and its tables have no answer and no
  // measure of these logs
  const Outcome tables = Experiment("export", {"--out", folder_.File("tables")});
  EXPECT_THAT(tables.err, AllOf(HasSubstr((other / "trial-1-mid.lcm").string() +
                                          ": the log is of trial 1 of participant 1"),
                                HasSubstr((other / "trial-2-high.lcm").string() +
                                          ": the log has no facts of a trial"),
                                Not(HasSubstr((own / "trial").string()))));
  const auto rows = ExportedTrials(1);
  ASSERT_THAT(rows, SizeIs(5));
  for (const auto& row : {rows[3], rows[4]}) {
    EXPECT_EQ(row.at("state"), "broken");
    EXPECT_EQ(row.at("kss.sleepiness"), "");
    EXPECT_EQ(row.at("collision"), "");
  }
  // AND participant 2 can make all three trials. The wrong logs do not count as trials 1 and 2
  EXPECT_EQ(RunCommand(Session(2)).code, 0);
  EXPECT_THAT(Experiment("status").out, HasSubstr("6 of 12 trials"));
}

}  // namespace
}  // namespace fogline::test
