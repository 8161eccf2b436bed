// Trials in which the participant drives at the seat, with the real programs. The test takes the
// place of both pages of the participant: the page of the session, and the page /drive.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "services/log/driver_inputs.h"
#include "services/log/run_log.h"
#include "tests/integration/drive/driven_run.h"
#include "tests/integration/drive/page_person.h"
#include "tests/integration/experiment/page_session.h"
#include "tests/integration/web/viewed.h"
#include "tests/unit/tools/trials/desk/taken_port.h"

namespace fogline::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// The name of the channel DRIVER_INPUT. If a log contains this name, the recorder has written an
/// input of the seat.
const std::string kInputs(ChannelOf<driver_input_t>().name);

/// The port and the token of the seat of a run. The participant's page gets both in its state.
struct SeatPlace {
  std::uint16_t port = 0;
  std::string token;
};

/// @throws std::runtime_error if the state has no address of a seat with a token
SeatPlace SeatIn(const nlohmann::json& state) {
  static const std::regex address("http://127.0.0.1:(\\d+)/drive#token=([0-9a-f]{32})");
  std::smatch parts;
  const std::string seat = state["seat"];
  if (!std::regex_match(seat, parts, address)) throw std::runtime_error(state.dump());
  return {.port = static_cast<std::uint16_t>(std::stoi(parts[1])), .token = parts[2]};
}

std::vector<driver_input_t> InputsIn(const std::filesystem::path& log) {
  log::RunLogReader reader(log);
  while (reader.Next() != nullptr) {
  }
  return log::ReadDriverInputs(log, reader.run().run_id);
}

/// The instances of all seats that have sent an input of a person who was present.
std::set<std::int64_t> SeatsIn(const std::filesystem::path& log) {
  std::set<std::int64_t> seats;
  for (const driver_input_t& input : InputsIn(log)) {
    if (input.present) seats.insert(input.instance);
  }
  return seats;
}

/// Expects that the driver has used the inputs of the person, and that the person has got
/// authority.
void ExpectIsDrivenByThePerson(const std::filesystem::path& log) {
  const std::vector<driver_input_t> inputs = InputsIn(log);
  EXPECT_GT(std::ranges::count_if(inputs, &driver_input_t::present), 40) << log;
  const std::set<std::int64_t> seats = SeatsIn(log);
  EXPECT_EQ(seats.size(), 1U) << log;
  log::RunLogReader reader(log);
  int by_seat = 0;
  int by_human = 0;
  while (const log::StepMessages* step = reader.Next()) {
    driver_command_t command;
    arbitration_t host;
    // In real time a message of a step may be missing.
    if (runtime::Decode((*step)[IndexOf<driver_command_t>()], command)) {
      by_seat += seats.contains(command.input_instance) ? 1 : 0;
    }
    if (runtime::Decode((*step)[IndexOf<arbitration_t>()], host)) {
      by_human += host.lambda_human > 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(by_seat, 100) << log;
  EXPECT_GT(by_human, 50) << log;
}

/// How often `text` is in `all`.
std::size_t CountOf(const std::string& text, const std::string& all) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = all.find(text, at)) != std::string::npos; ++at) ++count;
  return count;
}

/// One participant; each run has 400 steps of 0.02 s.
class DrivenTrialsInRealtimeTest : public ::testing::Test {
 protected:
  DrivenTrialsInRealtimeTest() { WritePlan(400); }

  /// @param by_person the changes of the scenario in the conditions in which the person drives
  void WritePlan(int steps, std::vector<std::string> by_person = AlwaysAskedAtAPage()) const {
    const std::string length = "/steps=" + std::to_string(steps);
    const std::string drive = (SourceDirectory() / kDriveScenario).string();
    by_person.push_back(length);
    const nlohmann::json plan{{"version", 1},
                              {"title", "Test"},
                              {"participants", 1},
                              {"order", "as_listed"},
                              {"conditions",
                               {{{"name", "secret-a"}, {"scenario", drive}, {"set", by_person}},
                                {{"name", "secret-model"}, {"scenario", drive}, {"set", {length}}},
                                {{"name", "secret-b"}, {"scenario", drive}, {"set", by_person}}}},
                              {"questionnaires", {{{"name", "kss"}, {"kind", "kss"}}}}};
    std::ofstream(file_) << plan.dump(2);
  }

  std::vector<std::string> Run(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {Program("fogline"), "experiment", "run", file_, "--results",
                               results_, "--participant", "1"});
    return more;
  }
  std::filesystem::path LogOf(const std::string& trial) const {
    return std::filesystem::path(results_) / "participant-01" / (trial + ".lcm");
  }
  /// Waits for the state of the participant's page in which the seat is open. @return this state
  static nlohmann::json WaitForSeat(PageSession& session) {
    for (nlohmann::json state = session.NextState(-1);; state = session.NextState(state["state"])) {
      if (state["stage"] == "waiting") session.Begin(state);
      if (state["stage"] == "seating") return state;
    }
  }
  static void ExpectReplaysBitByBit(const std::filesystem::path& log) {
    const Outcome replay =
        RunCommand({Program("fogline"), "replay", log.string(), "--role", "driver", "--json"});
    EXPECT_EQ(replay.code, 0) << replay.err;
    EXPECT_THAT(replay.out, HasSubstr("\"same\": true"));
  }

  ScratchFolder folder_;
  std::string file_ = folder_.File("experiment.json");
  std::string results_ = folder_.File("results");
};

TEST_F(DrivenTrialsInRealtimeTest, ThePageOpensTheSeatOnlyInTrialsInWhichTheParticipantDrives) {
  PageSession session(Run());
  std::optional<PagePerson> person;
  std::vector<std::string> stages;
  for (std::int64_t known = -1;;) {
    const nlohmann::json state = session.NextState(known);
    known = state["state"];
    EXPECT_THAT(state.dump(), Not(HasSubstr("secret")));
    const std::string stage = state["stage"];
    if (stages.empty() || stages.back() != stage) stages.push_back(stage);
    if (stage == "waiting") session.Begin(state);
    if (stage == "seating" && !person) {
      const SeatPlace seat = SeatIn(state);
      person.emplace(seat.port, PageSession::SocketTarget(seat.token));
    }
    if (stage == "asking") {
      person.reset();
      session.Answer(state, 3);
    }
    if (stage == "finished") break;
  }
  EXPECT_EQ(session.process().Wait(), 0) << session.process().Err();
  EXPECT_THAT(stages, ::testing::IsSupersetOf({"seating", "driving", "asking", "finished"}));
  EXPECT_EQ(std::ranges::count(stages, "seating"), 2);
  EXPECT_EQ(std::ranges::count(stages, "driving"), 3);
  for (const char* trial : {"trial-1-secret-a", "trial-3-secret-b"}) {
    ExpectIsDrivenByThePerson(LogOf(trial));
    ExpectReplaysBitByBit(LogOf(trial));
  }
  EXPECT_TRUE(InputsIn(LogOf("trial-2-secret-model")).empty());
}

TEST_F(DrivenTrialsInRealtimeTest, TheSeatTellsNothingOfTheCondition) {
  constexpr double kThreshold = 0.43219876;
  // The run has 600 steps, because on a busy machine the second client of the seat may connect
  // late.
  WritePlan(600, {"/person/drives=true", "/arbitrator/threshold=0.43219876", "/seed=918273645",
                  "/title=secret-title"});
  PageSession session(Run());
  const SeatPlace seat = SeatIn(WaitForSeat(session));
  const PagePerson person(seat.port, PageSession::SocketTarget(seat.token));
  while (session.NextState(-1)["stage"] != "driving") continue;
  // Each client of the seat gets the same messages of the run, even a client that does not drive.
  WebClient reader(
      seat.port, {.target = PageSession::SocketTarget(seat.token), .protocol = "fogline.drive.v1"});
  std::string all;
  std::map<std::uint16_t, int> messages;
  try {
    while (true) {
      const WebFrame frame = reader.Receive();
      all += frame.bytes;
      for (const WebMessage& message : MessagesOf(frame)) ++messages[message.channel];
    }
  } catch (const WebClosed&) {
    // The run has ended.
  }
  EXPECT_THAT(all, HasSubstr("\"op\":\"run\""));
  EXPECT_GT(messages[IndexOf<truth_t>()], 100);
  EXPECT_GT(messages[IndexOf<arbitration_t>()], 100);
  EXPECT_GT(messages[IndexOf<driver_command_t>()], 100);
  EXPECT_THAT(messages, ::testing::SizeIs(3));
  std::string encoded(sizeof(kThreshold), '\0');  // big-endian, as in a message
  const auto bits = std::bit_cast<std::uint64_t>(kThreshold);
  for (int i = 0; i < 8; ++i) encoded[i] = static_cast<char>(bits >> (56 - 8 * i));
  for (const std::string& hidden :
       {encoded, std::string("secret"), std::string("0.43219876"), std::string("918273645"),
        std::string("traded"), std::string("policy")}) {
    EXPECT_THAT(all, Not(HasSubstr(hidden)));
  }
  session.process().Signal(SIGINT);
  EXPECT_EQ(session.process().Wait(), 130);
}

TEST_F(DrivenTrialsInRealtimeTest, AfterAKillOfFoglineWebTheParticipantDrivesOnAtTheSameAddress) {
  WritePlan(1200);  // long enough for a start of fogline-web on a busy machine
  PageSession session(Run());
  std::optional<PagePerson> person;
  std::set<std::string> seats;
  std::vector<bool> open;  // at each change: whether the page has an address of the seat
  bool killed = false;
  for (std::int64_t known = -1;;) {
    const nlohmann::json state = session.NextState(known);
    known = state["state"];
    if (state["stage"] == "waiting" && state["run"] == 1) session.Begin(state);
    if (state["stage"] == "asking") break;
    const std::string address = state.value("seat", "");
    if (state["stage"] == "driving" && (open.empty() || open.back() == address.empty())) {
      open.push_back(!address.empty());
    }
    if (address.empty()) continue;
    seats.insert(address);
    const SeatPlace seat = SeatIn(state);
    if (!person) person.emplace(seat.port, PageSession::SocketTarget(seat.token));
    if (state["stage"] == "driving" && !std::exchange(killed, true)) {
      ASSERT_TRUE(ComesToHave(kInputs, LogOf("trial-1-secret-a")));
      session.KillView();
    }
  }
  person.reset();
  EXPECT_EQ(seats.size(), 1U);
  ASSERT_GE(open.size(), 3U);
  EXPECT_THAT(std::vector<bool>(open.begin(), open.begin() + 3), ElementsAre(true, false, true));
  session.WaitForLine("fogline-web runs again");
  EXPECT_THAT(session.process().Err(), HasSubstr("fogline-web was killed by signal 9"));
  EXPECT_EQ(SeatsIn(LogOf("trial-1-secret-a")).size(), 2U)
      << "the person has driven before and after";
  ExpectReplaysBitByBit(LogOf("trial-1-secret-a"));
  session.process().Signal(SIGINT);
  EXPECT_EQ(session.process().Wait(), 130);
}

TEST_F(DrivenTrialsInRealtimeTest, ASeatThatDoesNotComeBackEndsTheSessionBeforeTheRun) {
  const std::uint16_t port = FreePort();
  PageSession session(Run({"--seat-port", std::to_string(port)}));
  EXPECT_EQ(SeatIn(WaitForSeat(session)).port, port);
  TakenPort taken(port);
  const TimePoint end = Clock::now() + kPatience;
  while (!taken.Take()) {  // the session may start fogline-web again before the test has the port
    ASSERT_LT(Clock::now(), end);
    session.KillView();
    std::this_thread::sleep_for(kLookEvery);
  }
  EXPECT_EQ(session.process().Wait(), 3);
  const std::string err = session.process().Err();
  EXPECT_THAT(err, HasSubstr("fogline-web was started 5 times in vain"));
  // stderr has one line for each fogline-web that the test has killed, and one line for the first
  // failed start.
  const std::size_t kills = CountOf("was killed by signal 9", err);
  EXPECT_GE(kills, 1U) << err;
  // If the test kills a fogline-web that has not yet opened the seat, this kill counts as the first
  // failed start. Then there is no further line.
  EXPECT_THAT(CountOf("; it is started again", err), ::testing::AnyOf(kills, kills + 1)) << err;
  EXPECT_FALSE(std::filesystem::exists(LogOf("trial-1-secret-a")));
}

TEST_F(DrivenTrialsInRealtimeTest, ACrashWhileTheParticipantSitsDownIsNoAttempt) {
  const std::string log = LogOf("trial-1-secret-a");
  {
    PageSession session(Run());
    WaitForSeat(session);
    session.process().Signal(SIGKILL);
    session.process().Wait();
  }
  ASSERT_TRUE(std::filesystem::exists(log)) << "the crash has left the log without a step";
  const Outcome status =
      RunCommand({Program("fogline"), "experiment", "status", file_, "--results", results_});
  EXPECT_THAT(status.out, Not(HasSubstr("broken")));
  PageSession session(Run());
  const SeatPlace seat = SeatIn(WaitForSeat(session));
  const PagePerson person(seat.port, PageSession::SocketTarget(seat.token));
  ASSERT_TRUE(ComesToHave(kInputs, log));
  EXPECT_FALSE(std::filesystem::exists(LogOf("trial-1-secret-a-attempt-2")));
  session.process().Signal(SIGINT);
  EXPECT_EQ(session.process().Wait(), 130);
}

TEST_F(DrivenTrialsInRealtimeTest, OneParticipantHasTheSeatAndTheirTokenOpensNoView) {
  PageSession session(Run());
  const SeatPlace seat = SeatIn(WaitForSeat(session));
  const auto connect = [&](const std::string& token, const std::string& protocol) {
    return WebClient(seat.port, {.target = PageSession::SocketTarget(token), .protocol = protocol});
  };
  for (const std::string& token : {std::string(), seat.token, session.participant_token()}) {
    EXPECT_THROW(connect(token, "fogline.view.v1"), WebRefused);
  }
  EXPECT_THROW(connect("", "fogline.drive.v1"), WebRefused);
  WebClient first = connect(seat.token, "fogline.drive.v1");
  EXPECT_EQ(ReceiveOp(first, "seat")["state"], "yours");
  WebClient second = connect(seat.token, "fogline.drive.v1");
  EXPECT_EQ(ReceiveOp(second, "seat")["state"], "taken");
  // No run has begun, because no person has said that they are ready. So Ctrl-C leaves no log.
  EXPECT_EQ(Content(LogOf("trial-1-secret-a")), "");
  session.process().Signal(SIGINT);
  EXPECT_EQ(session.process().Wait(), 130);
  EXPECT_FALSE(std::filesystem::exists(LogOf("trial-1-secret-a")));
}

TEST_F(DrivenTrialsInRealtimeTest, ForOthersEachAddressHasATokenOfItsOwn) {
  PageSession session(Run({"--listen", "127.0.0.1"}));
  const SeatPlace seat = SeatIn(WaitForSeat(session));
  EXPECT_NE(seat.token, session.participant_token());
  EXPECT_THAT(session.process().Out(), Not(HasSubstr(seat.token)));
  // The experimenter's page has a link to the view, with the viewers' token.
  std::string view;
  while (view.empty()) {
    view = nlohmann::json::parse(session.experimenter().Receive().bytes)["view"];
  }
  EXPECT_THAT(view, HasSubstr("/#token="));
  EXPECT_THAT(view, Not(HasSubstr(seat.token)));
  session.process().Signal(SIGINT);
  EXPECT_EQ(session.process().Wait(), 130);
}

TEST_F(DrivenTrialsInRealtimeTest, WithoutAPageThePersonNeedsADevice) {
  const Outcome outcome = RunCommand(Run({"--no-page"}));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("--no-page: in condition \"secret-a\" the participant drives"));
}

TEST_F(DrivenTrialsInRealtimeTest, RefusesAPortThatIsTakenBeforeAnyoneBegins) {
  TakenPort taken(0);
  ASSERT_TRUE(taken.Take());
  const std::string port = std::to_string(taken.port());
  for (const std::string option : {"--seat-port", "--participant-port", "--experimenter-port"}) {
    const Outcome outcome = RunCommand(Run({option, port}));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("error: " + option + " " + port + ": cannot listen on"));
    EXPECT_EQ(outcome.out, "");
  }
}

TEST_F(DrivenTrialsInRealtimeTest, RefusesTwoPagesAtOnePort) {
  const std::string port = std::to_string(FreePort());
  const Outcome outcome = RunCommand(Run({"--participant-port", port, "--seat-port", port}));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--seat-port " + port + ": --participant-port has the same"));
}

TEST_F(DrivenTrialsInRealtimeTest, RefusesAPortBehindTheAddress) {
  const Outcome outcome = RunCommand(Run({"--listen", "127.0.0.1:80"}));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--listen 127.0.0.1:80: an address without a port"));
}

}  // namespace
}  // namespace fogline::test
