// A run on a port of its own is found without being told where it is: by top, doctor and roles. And
// every program obeys LCM_DEFAULT_URL. Each test has a meeting address of its own: what others
// announce on LCM's default address is nothing to it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "services/recorder/event_log.h"
#include "services/runtime/announcements.h"
#include "services/runtime/bus.h"
#include "services/runtime/this_process.h"
#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

// Programs start and messages arrive within this even when every processor is busy.
constexpr seconds kPatience(30);

/// The place where programs listen that are given no URL, as the environment names it.
class Meeting {
 public:
  const std::string& url() const { return url_; }

  /// A program there.
  std::vector<std::string> Command(const std::string& program,
                                   const std::vector<std::string>& arguments) const {
    std::vector<std::string> command{"env", "LCM_DEFAULT_URL=" + url_, Program(program)};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
  }
  /// A run of the paper's scenario with a log of its own.
  std::vector<std::string> Run(const std::vector<std::string>& more) {
    ++logs_;
    std::vector<std::string> arguments{"run", "scenario/paper.json", "--log", Log()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Command("fogline", arguments);
  }
  /// The log of the last run.
  std::string Log() const { return folder_.File(std::to_string(logs_) + ".lcm"); }

 private:
  std::string url_ = FreshMulticastUrl();
  ScratchFolder folder_;
  int logs_ = 0;
};

/// What a run says on stderr: "run ID on URL".
struct Place {
  std::int64_t run_id = 0;
  std::string url;
};

Place PlaceOf(Background& run) {
  EXPECT_TRUE(run.WaitForErr("processes: ", kPatience)) << run.Err();
  std::istringstream words(run.Err());
  std::string word;
  Place place;
  words >> word >> place.run_id >> word >> place.url;
  return place;
}

/// What `fogline top` saw of one interval.
json TopOnce(const Meeting& meeting) {
  const Outcome top =
      RunCommand(meeting.Command("fogline", {"top", "--once", "--json", "--interval", "0.5"}));
  EXPECT_EQ(top.code, 0) << top.err;
  return json::parse(top.out, nullptr, false);
}

/// `fogline top --json`, a document for each interval.
class Top {
 public:
  explicit Top(const Meeting& meeting)
      : process_(meeting.Command("fogline", {"top", "--json", "--interval", "0.1"})) {}

  /// Waits for a document that is as it should be. @return it, or the last one
  json WaitFor(const std::function<bool(const json&)>& good) {
    const TimePoint end = Clock::now() + kPatience;
    json document;
    for (; Clock::now() < end; std::this_thread::sleep_for(kLookEvery)) {
      std::string out = process_.Out();
      if (out.find('\n') == std::string::npos) continue;
      out.erase(out.rfind('\n'));
      document = json::parse(out.substr(out.rfind('\n') + 1));
      if (good(document)) return document;
    }
    ADD_FAILURE() << document.dump(1);
    return document;
  }

 private:
  Background process_;
};

beacon_t Beacon(std::int64_t run_id, const std::string& url) {
  beacon_t beacon{};
  beacon.header.run_id = run_id;
  beacon.began_us = 1;
  beacon.url = url;
  beacon.scenario = "invented";
  beacon.host = HostName();
  beacon.pid = 1;
  beacon.awaited = {"driver"};
  beacon.num_awaited = 1;
  return beacon;
}

void Say(Bus& bus, const beacon_t& beacon) {
  std::vector<std::uint8_t> bytes;
  Encode(beacon, bytes);
  bus.Publish(kBeaconChannel, bytes);
}

std::string DirectDigest(const std::vector<std::string>& more = {}) {
  std::vector<std::string> command{Program("fogline"), "run",         "scenario/paper.json",
                                   "--json",           "--transport", "direct"};
  command.insert(command.end(), more.begin(), more.end());
  return json::parse(RunCommand(command).out)["digest"];
}

TEST(AnnounceTest, TopShowsARunOnAPortOfItsOwnWithoutBeingToldWhereItIs) {
  Meeting meeting;
  Background run(meeting.Run({"--transport", "udpm", "--pace", "1"}));
  const Place place = PlaceOf(run);
  EXPECT_NE(place.url.substr(0, place.url.find('?')), meeting.url().substr(0, place.url.find('?')));
  const json seen = TopOnce(meeting);
  EXPECT_EQ(seen["lcm_url"], place.url);
  ASSERT_EQ(seen["announced"].size(), 1U) << seen.dump(1);
  const json& announced = seen["announced"][0];
  EXPECT_EQ(announced["run_id"], place.run_id);
  EXPECT_EQ(announced["lcm_url"], place.url);
  EXPECT_EQ(announced["pid"], run.pid());
  EXPECT_EQ(announced["host"], HostName());
  EXPECT_EQ(announced["followed"], true);
  ASSERT_EQ(seen["runs"].size(), 1U) << seen.dump(1);
  EXPECT_EQ(seen["runs"][0]["run_id"], place.run_id);
  EXPECT_EQ(seen["runs"][0]["roles"].size(), kRoles.size());
  EXPECT_TRUE(seen["others"].empty()) << "a beacon is no traffic";
  // AND the head of the table says what it is
  const Outcome table =
      RunCommand(meeting.Command("fogline", {"top", "--once", "--interval", "0.5"}));
  EXPECT_THAT(table.out,
              HasSubstr("\nrun " + std::to_string(place.run_id) + " at " + place.url +
                        ", scenario Traded control in fog: the experiment of Sourav & Cheng 2024, "
                        "announced by pid " +
                        std::to_string(run.pid()) + " on " + HostName() + "\n"));
}

TEST(AnnounceTest, TopFollowsARunThatBeginsLaterAndGoesBackWhenItEnds) {
  Meeting meeting;
  Top top(meeting);
  const json before = top.WaitFor([](const json&) { return true; });
  EXPECT_THAT(before["lcm_url"].get<std::string>(), testing::StartsWith(meeting.url()));
  EXPECT_TRUE(before["announced"].empty());
  Background run(meeting.Run({"--transport", "udpm", "--pace", "1"}));
  const Place place = PlaceOf(run);
  const json during = top.WaitFor([](const json& seen) { return seen["runs"].size() == 1; });
  EXPECT_EQ(during["lcm_url"], place.url);
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130);
  const json after = top.WaitFor([](const json& seen) { return seen["announced"].empty(); });
  EXPECT_EQ(after["lcm_url"], before["lcm_url"]);
}

TEST(AnnounceTest, TopFollowsTheNewestRunAndNamesTheOthers) {
  Meeting meeting;
  Background older(meeting.Run({"--transport", "udpm", "--pace", "1"}));
  const Place first = PlaceOf(older);
  Background newer(meeting.Run({"--transport", "tcpq", "--pace", "1"}));
  const Place second = PlaceOf(newer);
  Top top(meeting);
  const json seen = top.WaitFor([&second](const json& now) {
    return now["announced"].size() == 2 && !now["runs"].empty() &&
           now["runs"].back()["run_id"] == second.run_id;
  });
  EXPECT_EQ(seen["announced"][0]["run_id"], second.run_id);
  EXPECT_EQ(seen["announced"][1]["run_id"], first.run_id);
  EXPECT_EQ(seen["announced"][1]["followed"], false);
  EXPECT_EQ(seen["lcm_url"], second.url);
  // WHEN the newest is killed, which says nothing at its end, THEN the other one is followed
  newer.Signal(SIGKILL);
  top.WaitFor([&first](const json& now) { return now["lcm_url"] == first.url; });
}

TEST(AnnounceTest, TopThatIsGivenANetworkLooksAtThatAlone) {
  Meeting meeting;
  Background run(meeting.Run({"--transport", "udpm", "--pace", "1"}));
  PlaceOf(run);
  const Outcome top = RunCommand(meeting.Command(
      "fogline", {"top", "--once", "--json", "--interval", "1", "--lcm-url", meeting.url()}));
  const json seen = json::parse(top.out);
  EXPECT_TRUE(seen["runs"].empty());
  EXPECT_FALSE(seen.contains("announced"));
}

TEST(AnnounceTest, DoctorListsTheRunsAndWhatTheyWaitFor) {
  Meeting meeting;
  Background run(meeting.Run({"--transport", "udpm", "--external", "driver"}));
  const Place place = PlaceOf(run);
  const Outcome doctor = RunCommand(meeting.Command("fogline", {"doctor"}));
  EXPECT_THAT(doctor.out, HasSubstr("ok       run " + std::to_string(place.run_id) + " at " +
                                    place.url + ", scenario "));
  EXPECT_THAT(doctor.out, HasSubstr("; it waits for the driver\n"));
  EXPECT_THAT(doctor.out, Not(HasSubstr("FOGLINE_BEACON")));
}

TEST(AnnounceTest, RolesStartedWithoutAUrlJoinTheRunThatWaitsForThem) {
  Meeting meeting;
  Background driver(meeting.Command("fogline-driver", {}));
  Background acc(meeting.Command("fogline-acc", {}));
  for (Background* role : {&driver, &acc}) {
    ASSERT_TRUE(role->WaitForErr("waiting for a run on " + meeting.url(), kPatience))
        << role->Err();
  }
  EXPECT_THAT(driver.Err(),
              HasSubstr("; start one with: fogline run SCENARIO --external driver\n"));
  const Outcome run = RunCommand(
      meeting.Run({"--transport", "udpm", "--json", "--external", "driver", "--external", "acc"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["digest"], DirectDigest());
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  EXPECT_EQ(acc.Wait(), 0) << acc.Err();
  EXPECT_THAT(driver.Err(), HasSubstr("fogline-driver: joins run "));
}

TEST(AnnounceTest, ARoleThatIsKilledIsFoundAgainByItsSuccessor) {
  Meeting meeting;
  Background run(meeting.Run({"--transport", "udpm", "--json", "--external", "driver", "--pace",
                              "10", "--stall-timeout", "30"}));
  {
    Background first(meeting.Command("fogline-driver", {}));
    ASSERT_TRUE(first.WaitForErr("joins run ", kPatience)) << first.Err();
    ASSERT_TRUE(GrowsTo(20'000, meeting.Log(), kPatience));
    first.Signal(SIGKILL);
  }
  Background second(meeting.Command("fogline-driver", {}));
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_EQ(json::parse(run.Out())["digest"], DirectDigest());
  EXPECT_EQ(second.Wait(), 0) << second.Err();
}

TEST(AnnounceTest, ARoleComesBackFromARunThatIsNotThere) {
  Meeting meeting;
  Bus bus(meeting.url());
  Background driver(meeting.Command("fogline-driver", {}));
  ASSERT_TRUE(driver.WaitForErr("waiting for a run", kPatience));
  const TimePoint end = Clock::now() + kPatience;
  while (driver.Err().find("joins run 4711 ") == std::string::npos && Clock::now() < end) {
    Say(bus, Beacon(4711, FreshMulticastUrl()));
    bus.Wait(milliseconds(20));
  }
  ASSERT_TRUE(driver.WaitForErr(" again\n", kPatience)) << driver.Err();
  const Outcome run = RunCommand(meeting.Run({"--transport", "udpm", "--external", "driver"}));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST(AnnounceTest, WhatIsForgedIsRefusedAndCountedAndDisturbsNoRun) {
  Meeting meeting;
  Bus bus(meeting.url());
  Background driver(meeting.Command("fogline-driver", {}));
  ASSERT_TRUE(driver.WaitForErr("waiting for a run", kPatience));
  Top top(meeting);
  // GIVEN beacons that no runner of this machine sends, by the thousand, and noise
  const auto attack = [&] {
    for (std::int64_t i = 1; i <= 1000; ++i) {
      beacon_t beacon = Beacon(i, "udpm://10.0.0.1:7700");
      if (i % 3 == 0) beacon.url = "tcpq://192.0.2.1:7700";
      if (i % 5 == 0) beacon.scenario = "\x1b[2J";
      Say(bus, beacon);
      bus.Publish(kBeaconChannel, std::vector<std::uint8_t>(static_cast<std::size_t>(i), 0xff));
    }
  };
  attack();
  // WHEN a run goes on among them
  Background run(
      meeting.Run({"--transport", "udpm", "--json", "--external", "driver", "--pace", "5"}));
  const Place place = PlaceOf(run);
  attack();
  // THEN it is followed, and no other is
  top.WaitFor([&](const json& seen) {
    attack();
    return seen["announced"].size() == 1 && seen["announced"][0]["run_id"] == place.run_id &&
           seen["runs"].size() == 1;
  });
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_EQ(json::parse(run.Out())["digest"], DirectDigest());
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  // AND it is told how much of that there is
  Background doctor(meeting.Command("fogline", {"doctor"}));
  const TimePoint end = Clock::now() + kPatience;
  while (IsAlive(doctor.pid()) && Clock::now() < end) {
    Say(bus, Beacon(1, "udpm://10.0.0.1:7700"));
    bus.Wait(milliseconds(10));
  }
  doctor.Wait();
  EXPECT_THAT(doctor.Out(), HasSubstr(" announcements that no run of this machine can have made "
                                      "were refused"));
}

TEST(AnnounceTest, ABeaconIsNeitherInTheLogNorInTheDigest) {
  Meeting meeting;
  const Outcome run = RunCommand(
      meeting.Run({"--transport", "udpm", "--json", "--set", "/steps=30", "--pace", "20"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["digest"], DirectDigest({"--set", "/steps=30"}));
  EventLogReader log(meeting.Log());
  while (const auto event = log.Next()) {
    EXPECT_TRUE(std::ranges::any_of(kChannels, [&event](const ChannelInfo& channel) {
      return channel.name == event->channel && channel.Logged();
    })) << event->channel;
  }
}

TEST(DefaultUrlTest, IsWhereARunGoesThatIsNotToldOtherwise) {
  Meeting meeting;
  Background run(meeting.Run({"--pace", "1"}));
  EXPECT_THAT(PlaceOf(run).url, testing::StartsWith(meeting.url()));
  const json seen = TopOnce(meeting);
  EXPECT_EQ(seen["runs"].size(), 1U);
  EXPECT_TRUE(seen["announced"].empty()) << "it is where programs listen";
  // BUT the command line wins
  const std::string other = FreshMulticastUrl();
  Background told(meeting.Run({"--pace", "1", "--lcm-url", other}));
  EXPECT_THAT(PlaceOf(told).url, testing::StartsWith(other));
  const Outcome direct =
      RunCommand(meeting.Run({"--json", "--transport", "direct", "--set", "/steps=3"}));
  EXPECT_EQ(json::parse(direct.out)["transport"], "direct");
}

TEST(DefaultUrlTest, IsWhereRolesAndRunsMeet) {
  Meeting meeting;
  Background driver(meeting.Command("fogline-driver", {}));
  ASSERT_TRUE(driver.WaitForErr("waiting for a run on " + meeting.url(), kPatience));
  const Outcome run = RunCommand(meeting.Run({"--json", "--external", "driver"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["transport"], meeting.url());
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  EXPECT_THAT(driver.Err(), Not(HasSubstr("joins run")));
}

TEST(DefaultUrlTest, IsWhereATableFindsARoleFromElsewhere) {
  Meeting meeting;
  Background drivers({"env", "LCM_DEFAULT_URL=" + meeting.url(), "bash", "-c",
                      "while \"$1\"; do :; done", "-", Program("fogline-driver")});
  const std::vector<std::string> what{
      "table", "scenario/paper.json", "--json", "--thresholds", "0.5", "--set", "/steps=250"};
  std::vector<std::string> external = what;
  external.insert(external.end(), {"--external", "driver"});
  const Outcome table = RunCommand(meeting.Command("fogline", external));
  ASSERT_EQ(table.code, 0) << table.err;
  EXPECT_EQ(json::parse(table.out)["transport"], meeting.url());
  // A table without one is direct as ever.
  const Outcome direct = RunCommand(meeting.Command("fogline", what));
  EXPECT_EQ(json::parse(direct.out)["transport"], "direct");
  EXPECT_EQ(json::parse(direct.out)["rows"], json::parse(table.out)["rows"]);
}

TEST(DefaultUrlTest, IsNamedWhereItIsWrong) {
  for (const char* verb : {"top", "doctor", "spy"}) {
    const Outcome outcome =
        RunCommand({"env", "LCM_DEFAULT_URL=memq://", "DISPLAY=:0", Program("fogline"), verb});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err,
                HasSubstr("error: LCM_DEFAULT_URL memq://: the memory of one process"));
  }
  const Outcome run = RunCommand(
      {"env", "LCM_DEFAULT_URL=direct", Program("fogline"), "run", "scenario/paper.json"});
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.err,
            "fogline run: error: LCM_DEFAULT_URL is direct, which is no LCM URL such as "
            "\"udpm://239.255.76.67:7667?ttl=0\"\n");
}

TEST(WaitTest, OfARunSaysWhatIsMissingAndWhatStartsItAndHasALimit) {
  Meeting meeting;
  const Outcome run = RunCommand(meeting.Run(
      {"--transport", "udpm", "--external", "driver", "--external", "acc", "--wait", "0.5"}));
  EXPECT_EQ(run.code, 3);
  const std::string url =
      run.err.substr(run.err.find(" on ") + 4, run.err.find('\n') - run.err.find(" on ") - 4);
  EXPECT_THAT(run.err, HasSubstr("waiting for the driver (0.5 s): start it with: fogline-driver "
                                 "--lcm-url '" +
                                 url + "'\n"));
  EXPECT_THAT(run.err, HasSubstr("fogline run: error: waited 0.5 s for the acc, the driver in "
                                 "vain; start with: fogline-acc --lcm-url '" +
                                 url + "' and fogline-driver --lcm-url '" + url + "' "));
}

TEST(WaitTest, OfARunIsAMinuteUnlessSaidOtherwise) {
  Meeting meeting;
  Background minute(meeting.Run({"--transport", "udpm", "--external", "driver"}));
  EXPECT_TRUE(minute.WaitForErr("waiting for the driver (60 s): ", kPatience)) << minute.Err();
  Background endless(meeting.Run({"--transport", "udpm", "--external", "acc", "--wait", "0"}));
  EXPECT_TRUE(endless.WaitForErr("waiting for the acc (for ever): ", kPatience)) << endless.Err();
  Background acc(meeting.Command("fogline-acc", {}));
  EXPECT_EQ(endless.Wait(), 0) << endless.Err();
}

TEST(WaitTest, OfATableHasALimitToo) {
  const Meeting meeting;
  const Outcome table =
      RunCommand({Program("fogline"), "table", "scenario/paper.json", "--external", "driver",
                  "--lcm-url", meeting.url(), "--wait", "0.5"});
  EXPECT_EQ(table.code, 3);
  EXPECT_THAT(table.err, HasSubstr("each of 4 runs waits for the driver (0.5 s): start it for each "
                                   "with: fogline-driver --lcm-url '" +
                                   meeting.url()));
  EXPECT_THAT(table.err, HasSubstr("fogline table: error: waited 0.5 s for the driver in vain"));
}

TEST(WaitTest, OfARoleHasALimitToo) {
  const std::string url = FreshMulticastUrl();
  const Outcome driver = RunCommand({Program("fogline-driver"), "--lcm-url", url, "--wait", "0.5"});
  EXPECT_EQ(driver.code, 3);
  const std::string full = url + "&recv_buf_size=2097152";
  const std::string how =
      "; start one with: fogline run SCENARIO --external driver --lcm-url '" + url + "'";
  EXPECT_EQ(driver.err, "fogline-driver: waiting for a run on " + full + how +
                            "\nfogline-driver: error: waited 0.5 s for a run on " + full +
                            " in vain" + how + " (--wait 0 waits for ever)\n");
}

TEST(WaitTest, OfARoleThatTheRunnerStartsIsSilent) {
  const Outcome role = RunCommand({Program("fogline-driver"), "--lcm-url", FreshMulticastUrl(),
                                   "--run-id", "4711", "--wait", "0.2"});
  EXPECT_EQ(role.code, 3);
  EXPECT_THAT(role.err, testing::StartsWith("fogline-driver: error: waited 0.2 s for a run on "));
}

class AnnounceOnMachineTest : public NetworkTest {};

TEST_F(AnnounceOnMachineTest, ARunThatCannotAnnounceItselfGoesOnAndSaysNothingOfThat) {
  const Machine island("island");
  const Outcome run = RunCommand(island.On(Run({"--transport", "tcpq", "--set", "/steps=30"})));
  EXPECT_EQ(Result(run)["steps"], 30);
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 2) << run.err;
}

TEST_F(AnnounceOnMachineTest, ARunIsAnnouncedOnItsOwnMachineOnly) {
  const Lab lab(2);
  Background run(lab[0].On(Run({"--pace", "1", "--lcm-url", "udpm://239.255.76.67:7700?ttl=1"})));
  ASSERT_TRUE(run.WaitForErr("processes: ", kPatience)) << run.Err();
  const auto announced = [&lab](std::size_t place) {
    const Outcome top = RunCommand(
        lab[place].On({Program("fogline"), "top", "--once", "--json", "--interval", "0.2"}));
    return json::parse(top.out)["announced"].size();
  };
  EXPECT_EQ(announced(0), 1U);
  EXPECT_EQ(announced(1), 0U);
}

/// The lines of README.md that a person copies to record a run with lcm-logger.
std::string ReadmeLinesOfLogger() {
  std::ifstream in(SourceDirectory() / "README.md");
  std::string block;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("    ")) {
      block += line.substr(4) + "\n";
    } else if (block.find("lcm-logger ") != std::string::npos) {
      return block;
    } else {
      block.clear();
    }
  }
  return "";
}

TEST(ReadmeLinesTest, RecordARunWithLcmLoggerByTheLinesThatItShows) {
  // GIVEN the lines, with a port that no other test has, and a run of three seconds
  std::string lines = ReadmeLinesOfLogger();
  const std::string port = "udpm://239.255.76.67:7700?ttl=0";
  ASSERT_THAT(lines, HasSubstr(port));
  lines.replace(lines.find(port), port.size(), FreshMulticastUrl());
  const std::string run = "fogline run scenario/paper.json";
  ASSERT_THAT(lines, HasSubstr(run));
  lines.insert(lines.find(run) + run.size(), " --set /steps=30 --log run.lcm");
  // WHEN a shell does them in a folder of its own
  const ScratchFolder folder;
  std::filesystem::create_directory_symlink(SourceDirectory() / "scenario",
                                            folder.path() / "scenario");
  const Outcome shell =
      RunCommand({"bash", "-c",
                  "cd " + folder.path().string() + " && PATH=" + ProgramDirectory().string() +
                      ":$PATH\n" + lines + "\nkill -INT $!; wait"});
  // THEN lcm-logger has steps of the run; it begins with the one at which it was there
  EventLogReader log(folder.File("copy.lcm"));
  std::int64_t truths = 0;
  while (const auto event = log.Next()) truths += event->channel == "TRUTH" ? 1 : 0;
  EXPECT_GT(truths, 0) << shell.out << shell.err;
}

}  // namespace
}  // namespace fogline::test
