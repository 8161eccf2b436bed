// top, doctor and roles find a run that has its own port, although they do not get the run's URL.
// Each test has its own meeting address, so it receives no announcements of other runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <deque>
#include <functional>
#include <thread>

#include "common/process/this_process.h"
#include "services/log/about/log_graph.h"
#include "services/log/event_log.h"
#include "services/log/log_seal.h"
#include "services/runtime/discovery/announcements.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/network/meeting.h"
#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// `fogline top --json`, which prints a document for each interval.
class Top {
 public:
  explicit Top(const Meeting& meeting)
      : process_(meeting.Command("fogline", {"top", "--json", "--interval", "0.1"})) {}

  /// Waits for a document that `good` accepts. WaitFor() reads the output file every few
  /// milliseconds, because no event shows that the file has grown. @return this document, or the
  /// last document if `good` accepts none
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

void Say(runtime::Bus& bus, const beacon_t& beacon) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(beacon, bytes);
  bus.Publish(runtime::kBeaconChannel, bytes);
}

std::string DirectDigest(const std::vector<std::string>& more = {}) {
  std::vector<std::string> command{Program("fogline"), "run",         "scenario/paper.json",
                                   "--json",           "--transport", "direct"};
  command.insert(command.end(), more.begin(), more.end());
  return json::parse(RunCommand(command).out)["digest"];
}

TEST(AnnounceTest, TopShowsARunOnAPortOfItsOwnWithoutBeingToldWhereItIs) {
  Meeting meeting;
  Background run(meeting.Run({"--transport", "udpm", "--pace", "1", "--set", "/steps=10000"}));
  const Place place = PlaceOf(run);
  EXPECT_NE(place.url.substr(0, place.url.find('?')), meeting.url().substr(0, place.url.find('?')));
  // On a busy machine a process of the run may send nothing during the 3 s for which top listens.
  // Then the test calls top again.
  json seen = TopOnce(meeting);
  const auto is_whole = [&] {
    return seen["announced"].size() == 1 && seen["runs"].size() == 1 &&
           seen["runs"][0]["roles"].size() == kRoles.size();
  };
  for (const TimePoint end = Clock::now() + kPatience; !is_whole() && Clock::now() < end;) {
    seen = TopOnce(meeting);
  }
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
  // AND the head of the table names the run
  const Outcome table =
      RunCommand(meeting.Command("fogline", {"top", "--once", "--interval", "5"}));
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
  // WHEN the newest run is killed and so cannot announce its end, THEN top follows the other run
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
  const std::string found =
      "ok       run " + std::to_string(place.run_id) + " at " + place.url + ", scenario ";
  const Outcome doctor = RunUntilItPrints(meeting.Command("fogline", {"doctor"}), {found});
  EXPECT_THAT(doctor.out, HasSubstr(found));
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

TEST(AnnounceTest, OfTwoProcessesOfOneRoleOneTakesPartAndTheOtherWaits) {
  Meeting meeting;
  std::deque<Background> drivers;
  for (int i = 0; i < 2; ++i) {
    drivers.emplace_back(meeting.Command("fogline-driver", {}));
    ASSERT_TRUE(drivers.back().WaitForErr("waiting for a run", kPatience));
  }
  const Outcome run =
      RunCommand(meeting.Run({"--transport", "udpm", "--json", "--external", "driver"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["digest"], DirectDigest());
  EXPECT_TRUE(json::parse(run.out)["restarts"].empty()) << run.out;
  // AND the other driver takes part in the next run
  const Outcome next = RunCommand(meeting.Run({"--transport", "udpm", "--external", "driver"}));
  ASSERT_EQ(next.code, 0) << next.err;
  for (Background& driver : drivers) EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST(AnnounceTest, OfTwoProcessesOfOneRoleTheOtherTakesOverWhenTheFirstIsKilled) {
  Meeting meeting;
  std::deque<Background> drivers;
  for (int i = 0; i < 2; ++i) {
    drivers.emplace_back(meeting.Command("fogline-driver", {}));
    ASSERT_TRUE(drivers.back().WaitForErr("waiting for a run", kPatience));
  }
  // A driver needs up to 5 s, and more on a busy machine, to notice that another driver has the
  // role. The run must not end before that, so it takes 25 s.
  Background run(meeting.Run({"--transport", "udpm", "--json", "--external", "driver", "--pace",
                              "2", "--stall-timeout", "30"}));
  ASSERT_TRUE(GrowsTo(20'000, meeting.Log(), kPatience)) << run.Err();
  // GIVEN two drivers in the run. One driver has reported that the other driver has the role
  const auto is_other = [](const Background& driver) {
    const std::string said = driver.Err();
    return said.find("another process is the driver") != std::string::npos ||
           said.find(" again\n") != std::string::npos;
  };
  const TimePoint end = Clock::now() + kPatience;
  // No event tells the test that a driver has written to its stderr, which is a file. So the test
  // reads the file again and again.
  while (std::ranges::none_of(drivers, is_other) && Clock::now() < end) {
    std::this_thread::sleep_for(kLookEvery);
  }
  ASSERT_EQ(std::ranges::count_if(drivers, is_other), 1);
  Background& first = drivers[is_other(drivers[0]) ? 1 : 0];
  Background& other = drivers[is_other(drivers[0]) ? 0 : 1];
  // WHEN the first driver is killed THEN the other driver replaces it before the run fails
  first.Signal(SIGKILL);
  ASSERT_EQ(run.Wait(), 0) << run.Err() << other.Err();
  EXPECT_EQ(json::parse(run.Out())["digest"], DirectDigest());
  EXPECT_EQ(other.Wait(), 0) << other.Err();
}

/// Starts a run with an external driver, and kills its runner while the run is under way.
void KillRunner(Meeting& meeting, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"--external", "driver", "--pace", "1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  Background run(meeting.Run(arguments));
  ASSERT_TRUE(GrowsTo(20'000, meeting.Log(), kPatience)) << run.Err();
  run.Signal(SIGKILL);
  run.Wait();
}

TEST(AnnounceTest, ARoleOfAKilledRunnerGoesToTheNextRunThatWaitsForIt) {
  Meeting meeting;
  Background driver(meeting.Command("fogline-driver", {}));
  KillRunner(meeting, {"--transport", "udpm"});
  const Outcome run =
      RunCommand(meeting.Run({"--transport", "udpm", "--json", "--external", "driver"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["digest"], DirectDigest());
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST(AnnounceTest, ARunSaysThatTheRoleItWaitsForIsInARunWhoseRunnerIsSilent) {
  Meeting meeting;
  const std::string url = runtime::FreshMulticastUrl();
  Background driver(meeting.Command("fogline-driver", {"--lcm-url", url}));
  KillRunner(meeting, {"--lcm-url", url});
  const Outcome run = RunCommand(meeting.Run({"--lcm-url", url, "--json", "--external", "driver"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["digest"], DirectDigest());
  EXPECT_THAT(run.err, HasSubstr("driver (pid " + std::to_string(driver.pid()) + " on "));
  EXPECT_THAT(run.err, HasSubstr(" is not free: it joins this run when that run is over, or when "
                                 "its runner has been silent for 2 s\n"));
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  EXPECT_THAT(driver.Err(), HasSubstr(" waits for the driver\n"));
}

TEST(AnnounceTest, ARoleComesBackFromARunThatIsNotThere) {
  Meeting meeting;
  runtime::Bus bus(meeting.url());
  Background driver(meeting.Command("fogline-driver", {}));
  ASSERT_TRUE(driver.WaitForErr("waiting for a run", kPatience));
  const TimePoint end = Clock::now() + kPatience;
  while (driver.Err().find("joins run 4711 ") == std::string::npos && Clock::now() < end) {
    Say(bus, Beacon(4711, runtime::FreshMulticastUrl()));
    bus.Wait(milliseconds(20));
  }
  ASSERT_TRUE(driver.WaitForErr(" again\n", kPatience)) << driver.Err();
  const Outcome run = RunCommand(meeting.Run({"--transport", "udpm", "--external", "driver"}));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST(AnnounceTest, WhatIsForgedIsRefusedAndCountedAndDisturbsNoRun) {
  Meeting meeting;
  runtime::Bus bus(meeting.url());
  Background driver(meeting.Command("fogline-driver", {}));
  ASSERT_TRUE(driver.WaitForErr("waiting for a run", kPatience));
  Top top(meeting);
  // GIVEN thousands of forged beacons, and messages on the beacons' channel that are not beacons
  const auto attack = [&] {
    for (std::int64_t i = 1; i <= 1000; ++i) {
      beacon_t beacon = Beacon(i, "udpm://10.0.0.1:7700");
      if (i % 3 == 0) beacon.url = "tcpq://192.0.2.1:7700";
      if (i % 5 == 0) beacon.scenario = "\x1b[2J";
      Say(bus, beacon);
      bus.Publish(runtime::kBeaconChannel,
                  std::vector<std::uint8_t>(static_cast<std::size_t>(i), 0xff));
    }
  };
  attack();
  // WHEN a run takes place among these beacons
  Background run(
      meeting.Run({"--transport", "udpm", "--json", "--external", "driver", "--pace", "5"}));
  const Place place = PlaceOf(run);
  attack();
  // THEN top follows this run and no other
  top.WaitFor([&](const json& seen) {
    attack();
    return seen["announced"].size() == 1 && seen["announced"][0]["run_id"] == place.run_id &&
           seen["runs"].size() == 1;
  });
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_EQ(json::parse(run.Out())["digest"], DirectDigest());
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  // AND doctor reports that it refused announcements
  Background doctor(meeting.Command("fogline", {"doctor"}));
  const TimePoint end = Clock::now() + kPatience;
  while (IsAlive(doctor.pid()) && Clock::now() < end) {
    Say(bus, Beacon(1, "udpm://10.0.0.1:7700"));
    bus.Wait(milliseconds(10));
  }
  doctor.Wait();
  EXPECT_THAT(
      doctor.Out(),
      HasSubstr(" announcements were refused, because no run of this machine can have made them"));
}

TEST(AnnounceTest, ABeaconIsNeitherInTheLogNorInTheDigest) {
  Meeting meeting;
  const Outcome run = RunCommand(
      meeting.Run({"--transport", "udpm", "--json", "--set", "/steps=30", "--pace", "20"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["digest"], DirectDigest({"--set", "/steps=30"}));
  log::EventLogReader log(meeting.Log());
  while (const auto event = log.Next()) {
    EXPECT_TRUE(log::IsLogSeal(*event) || event->channel == log::kLogGraphChannel ||
                std::ranges::any_of(kChannels,
                                    [&event](const ChannelInfo& channel) {
                                      return channel.name == event->channel && channel.Logged();
                                    }))
        << event->channel;
  }
}

class AnnounceOnMachineTest : public NetworkTest {};

TEST_F(AnnounceOnMachineTest, ARunThatCannotAnnounceItselfGoesOnAndSaysNothingOfThat) {
  const Machine island("island");
  // If LCM_DEFAULT_URL names a relay (TCP), runs do not announce themselves.
  std::vector<std::string> command{"env", "LCM_DEFAULT_URL=tcpq://127.0.0.1:1"};
  const auto rest = Run({"--transport", "udpm", "--set", "/steps=30"});
  command.insert(command.end(), rest.begin(), rest.end());
  const Outcome run = RunCommand(island.On(command));
  EXPECT_EQ(Result(run)["steps"], 30);
  EXPECT_EQ(LinesBesideDelays(run.err), 2) << run.err;
}

TEST_F(AnnounceOnMachineTest, ARunIsAnnouncedAlsoIfTheMeetingAddressIsThatOfAnotherNetwork) {
  const Lab lab(1);
  const auto with = [&lab](std::vector<std::string> command) {
    command.insert(command.begin(), {"env", "LCM_DEFAULT_URL=udpm://239.255.76.67:7700?ttl=1"});
    return lab[0].On(command);
  };
  // A driver without a URL finds the run of another network only by its announcement.
  Background driver(with({Program("fogline-driver")}));
  const Outcome run = RunCommand(with(
      Run({"--transport", "tcpq", "--set", "/steps=30", "--external", "driver", "--wait", "60"})));
  EXPECT_EQ(Result(run)["steps"], 30);
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST_F(AnnounceOnMachineTest, ARunIsAnnouncedOnItsOwnMachineOnly) {
  const Lab lab(2);
  Background run(lab[0].On(Run(
      {"--pace", "1", "--set", "/steps=10000", "--lcm-url", "udpm://239.255.76.67:7700?ttl=1"})));
  ASSERT_TRUE(run.WaitForErr("processes: ", kPatience)) << run.Err();
  const auto announced = [&lab](std::size_t place) {
    const Outcome top = RunCommand(
        lab[place].On({Program("fogline"), "top", "--once", "--json", "--interval", "5"}));
    return json::parse(top.out)["announced"].size();
  };
  // On a busy machine the runner may send nothing during the 5 s for which top listens. Then the
  // test calls top again.
  std::size_t here = announced(0);
  const TimePoint end = Clock::now() + kPatience;
  while (here != 1 && Clock::now() < end) here = announced(0);
  EXPECT_EQ(here, 1U);
  EXPECT_EQ(announced(1), 0U);
}

}  // namespace
}  // namespace fogline::test
