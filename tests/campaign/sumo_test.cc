// Preceding cars from SUMO. `tools/setup bench` installs SUMO.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/log/run_log.h"
#include "services/runtime/wire/wire.h"
#include "tests/integration/faults/watched_run.h"
#include "tests/integration/runs/transports.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

constexpr const char* kQueue = "scenario/sumo_queue.json";

class SumoTest : public testing::Test {
 protected:
  nlohmann::json Run(const std::string& transport, const std::vector<std::string>& fields = {}) {
    return RunOn(transport, kQueue, log_, fields);
  }

  /// TRUTH of each step of the last run.
  std::vector<truth_t> Truths() const {
    std::vector<truth_t> truths;
    log::RunLogReader reader(log_);
    while (const log::StepMessages* messages = reader.Next()) {
      EXPECT_TRUE(runtime::Decode((*messages)[IndexOf<truth_t>()], truths.emplace_back()));
    }
    return truths;
  }

  /// The steps at which another car becomes the car ahead. At such a step the position of the car
  /// ahead does not follow from its speed.
  static std::vector<std::int64_t> Changes(const std::vector<truth_t>& truths) {
    constexpr double kStep_s = 0.1;
    std::vector<std::int64_t> steps;
    for (std::size_t i = 1; i < truths.size(); ++i) {
      const truth_t& before = truths[i - 1];
      const truth_t& now = truths[i];
      const double driven_m = (before.preceding_speed_mps + now.preceding_speed_mps) / 2 * kStep_s;
      const double jump_m = now.preceding_position_m - before.preceding_position_m - driven_m;
      if (std::abs(jump_m) > 1e-3) steps.push_back(now.header.step);
    }
    return steps;
  }

  std::string ErrorOf(const std::vector<std::string>& fields) const {
    std::vector<std::string> command{Program("fogline"), "check", kQueue};
    for (const std::string& field : fields) command.insert(command.end(), {"--set", field});
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::vector<std::string> behind_a_queue_{
      "--set", "/lead/profile=sumo",
      "--set", "/lead/sumo/net_file=data/sumo_queue/road.net.xml",
      "--set", "/lead/sumo/route_file=data/sumo_queue/cars.rou.xml",
      "--set", "/lead/sumo/behind=queue.20"};
};

TEST_F(SumoTest, ARunBehindAQueueHasOneDigestOnEveryTransport) {
  const nlohmann::json direct = ExpectTheSameOnAnyTransport(
      [this](const std::string& transport) { return Run(transport); }, 1000);
  EXPECT_EQ(direct["metrics"]["collision"], 0);
  log::RunLogReader reader(log_);
  while (reader.Next() != nullptr) continue;
  EXPECT_THAT(reader.run().scenario.lead.sumo.version, MatchesRegex("SUMO [0-9]+\\.[0-9]+.*"));
}

TEST_F(SumoTest, AWorldThatIsKilledTwiceComputesTheSameRun) {
  WatchedRun watched({}, 600, kPace, behind_a_queue_);
  for (const int step : {200, 500}) {
    watched.WaitForStep(step);
    watched.Signal("world", SIGKILL);
  }
  const nlohmann::json result = watched.ExpectSameResult();
  EXPECT_EQ(WatchedRun::RestartsOf(result, "world"), 2);
}

// The test stops the process of the world again and again. So the world gets little processor time,
// as on a busy machine, and needs seconds to load SUMO.
TEST_F(SumoTest, AWorldThatLoadsSumoForLongIsNotTakenForHung) {
  WatchedRun watched({}, 60, kPace, behind_a_queue_);
  const pid_t world = watched.PidOf("world");
  const TimePoint began = Clock::now();
  while (watched.StateOf("world", world) == status_t::WAITING) {
    kill(world, SIGSTOP);
    std::this_thread::sleep_for(milliseconds(99));  // the world is stopped this long
    kill(world, SIGCONT);
    watched.Listen(milliseconds(1));
    ASSERT_LT(Clock::now() - began, kPatience);
  }
  // A silent process that does not work is killed after 2 s. This world needs more than 4 s to load
  // SUMO, and must not be killed.
  EXPECT_GT(Clock::now() - began, milliseconds(4000)) << "the world was not slow";
  EXPECT_EQ(WatchedRun::RestartsOf(watched.ExpectSameResult(), "world"), 0);
}

TEST_F(SumoTest, TheSeedChangesTheQueue) {
  const std::string first = Run("direct")["digest"];
  EXPECT_NE(Run("direct", {"/seed=2"})["digest"], first);
  EXPECT_EQ(Run("direct", {"/seed=1"})["digest"], first);
}

TEST_F(SumoTest, ACarMergesInFrontOfTheHostAndTheQueueBrakesBeforeTheRoadWorks) {
  Run("direct");
  const std::vector<truth_t> truths = Truths();
  const std::vector<std::int64_t> changes = Changes(truths);
  ASSERT_EQ(changes.size(), 1U);
  const auto merged = static_cast<std::size_t>(changes.front());
  EXPECT_LT(truths[merged].host_gap_m, truths[merged - 1].host_gap_m - 8);
  EXPECT_NEAR(static_cast<double>(merged) * 0.1, 45, 3);  // s
  const auto slowest = std::ranges::min(truths, {}, &truth_t::preceding_speed_mps);
  EXPECT_NEAR(slowest.preceding_speed_mps, 10, 1);
  EXPECT_NEAR(truths.front().host_gap_m, 33, 1e-9);
}

TEST_F(SumoTest, TheMergingCarSeesTheHost) {
  // GIVEN a host that leaves no room between itself and the queue
  Run("direct", {"/acc/headway_s=0.5", "/driver/headway_s=0.5", "/world/host_gap_m=13"});
  // THEN no car merges, although a car merges in front of a host that leaves more room
  EXPECT_THAT(Changes(Truths()), testing::IsEmpty());
}

TEST_F(SumoTest, SeveralThreadsOfASweepGiveTheResultsOfSingleRuns) {
  const std::string rows = folder_.File("rows.csv");
  const Outcome sweep = RunCommand({Program("fogline"), "sweep", kQueue, "--seeds", "1:4", "--jobs",
                                    "2", "--set", "/steps=600", "--out", rows});
  ASSERT_EQ(sweep.code, 0) << sweep.err;
  std::istringstream lines(Content(rows));
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  const auto column = std::ranges::find(names, "min_host_gap_m") - names.begin();
  ASSERT_LT(static_cast<std::size_t>(column), names.size());
  for (int seed = 1; seed <= 4; ++seed) {
    ASSERT_TRUE(std::getline(lines, line));
    std::istringstream row(line);
    std::string cell;
    for (long i = 0; i <= column; ++i) std::getline(row, cell, ',');
    const auto run = Run("direct", {"/steps=600", "/seed=" + std::to_string(seed)});
    EXPECT_EQ(std::stod(cell), run["metrics"]["min_host_gap_m"].get<double>()) << line;
  }
}

TEST_F(SumoTest, WhatSumoRefusesIsNamedBeforeTheRun) {
  const std::string begin = std::string(kQueue) + ": error: ";
  EXPECT_EQ(ErrorOf({"/lead/sumo/behind=queue.21"}),
            begin +
                "/lead/sumo/behind: SUMO has no car \"queue.21\" at 1 s; it has queue.1, "
                "queue.10, queue.11, queue.12, queue.13, ...\n");
  EXPECT_EQ(ErrorOf({"/lead/sumo/behind=queue.19"}),
            begin +
                "/lead/sumo/behind: between the host and \"queue.19\" is another car: "
                "queue.20\n");
  EXPECT_THAT(ErrorOf({"/followers/count=12"}), HasSubstr("/lead/sumo/behind: the road ends 343"));
  EXPECT_EQ(
      ErrorOf({"/lead/sumo/version=SUMO 0.1"}).find(begin + "/lead/sumo/version: \"SUMO 0.1\""),
      0U);
  EXPECT_EQ(ErrorOf({"/step_s=0.0125"}),
            begin +
                "/step_s: 0.0125 s is no whole number of milliseconds, in which SUMO counts "
                "time\n");
  EXPECT_THAT(ErrorOf({"/lead/sumo/net=[\"<net>\"]"}), HasSubstr("/lead/sumo: SUMO: "));
  EXPECT_THAT(ErrorOf({"/lead/sumo/routes=[\"<routes><vehicle id='a' route='b'/></routes>\"]"}),
              HasSubstr("/lead/sumo: SUMO: "));
}

TEST_F(SumoTest, AHostThatReachesTheEndOfTheRoadEndsTheRunWithThatReason) {
  const Outcome outcome = RunCommand({Program("fogline"), "run", kQueue, "--transport", "direct",
                                      "--quiet", "--log", log_, "--set", "/steps=4000"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("SUMO: the host reaches the end of its lane, "));
}

TEST_F(SumoTest, ARoadOnWhichEachLaneLeadsToTwoIsReadAtOnce) {
  // There are 2^40 routes along the 40 edges of this road. A program that follows each route would
  // not end.
  constexpr int kEdges = 40;
  std::ofstream nodes(folder_.File("mesh.nod.xml"));
  std::ofstream edges(folder_.File("mesh.edg.xml"));
  std::ofstream connections(folder_.File("mesh.con.xml"));
  std::ofstream routes(folder_.File("mesh.rou.xml"));
  nodes << "<nodes><node id='0' x='0' y='0'/>";
  edges << "<edges>";
  connections << "<connections>";
  routes << "<routes><vType id='car' length='4.5'/><route id='along' edges='";
  for (int i = 1; i <= kEdges; ++i) {
    nodes << "<node id='" << i << "' x='" << 100 * i << "' y='0'/>";
    edges << "<edge id='e" << i << "' from='" << i - 1 << "' to='" << i
          << "' numLanes='2' speed='20'/>";
    routes << (i > 1 ? " e" : "e") << i;
    for (int lane = 0; i < kEdges && lane < 4; ++lane) {
      connections << "<connection from='e" << i << "' to='e" << i + 1 << "' fromLane='" << lane / 2
                  << "' toLane='" << lane % 2 << "'/>";
    }
  }
  nodes << "</nodes>" << std::flush;
  edges << "</edges>" << std::flush;
  connections << "</connections>" << std::flush;
  routes << "'/><vehicle id='ahead' type='car' route='along' depart='0' departPos='90' "
            "departSpeed='20' insertionChecks='none'/></routes>"
         << std::flush;
  const std::string net = folder_.File("mesh.net.xml");
  const Outcome made =
      RunCommand({"netconvert", "--node-files", folder_.File("mesh.nod.xml"), "--edge-files",
                  folder_.File("mesh.edg.xml"), "--connection-files", folder_.File("mesh.con.xml"),
                  "--no-turnarounds", "--output-file", net});
  ASSERT_EQ(made.code, 0) << made.err;
  const Outcome check = RunCommand(
      {"timeout", "60", Program("fogline"), "check", kQueue, "--set", "/lead/sumo/net_file=" + net,
       "--set", "/lead/sumo/route_file=" + folder_.File("mesh.rou.xml"), "--set",
       "/lead/sumo/behind=ahead", "--set", "/followers/count=1"});
  EXPECT_EQ(check.code, 0) << check.err;
}

TEST_F(SumoTest, NetconvertMakesTheShippedNetwork) {
  const std::filesystem::path data = SourceDirectory() / "scenario/data/sumo_queue";
  const auto file = [&](const char* name) { return (data / name).string(); };
  const std::string made = folder_.File("road.net.xml");
  const Outcome outcome =
      RunCommand({"netconvert", "--node-files", file("road.nod.xml"), "--edge-files",
                  file("road.edg.xml"), "--connection-files", file("road.con.xml"),
                  "--no-turnarounds", "--offset.disable-normalization", "--output-file", made});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto from_net = [](const std::string& text) { return text.substr(text.find("<net ")); };
  EXPECT_EQ(from_net(Content(made)), from_net(Content(file("road.net.xml"))));
}

}  // namespace
}  // namespace fogline::test
