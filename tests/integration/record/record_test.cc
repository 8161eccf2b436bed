// `fogline record` writes all messages of a network, no matter which LCM program sends them.
#include <lcm/lcm.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include <gmock/gmock.h>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/integration/record/recorder_process.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/machine.h"
#include "tests/support/numbered_sender.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

std::vector<std::uint8_t> Payload(std::size_t number, std::size_t size) {
  std::vector<std::uint8_t> payload(size);
  for (std::size_t i = 0; i < size; ++i) {
    payload[i] = static_cast<std::uint8_t>(number + i * (number + 1));
  }
  return payload;
}

class RecordTest : public testing::Test {
 protected:
  const ScratchFolder folder_;
  const std::string log_ = folder_.File("all.lcm");
  runtime::Bus bus_{runtime::FreshMulticastUrl()};
};

TEST_F(RecordTest, HasEveryMessageOfABurstOfWhichLcmLoggerLosesSome) {
  // The kernel gives only root a buffer that is large enough.
  if (geteuid() != 0) return MachineLacks("root, for a large receive buffer");
  // GIVEN lcm-logger and fogline record, both listening
  const std::string theirs = folder_.File("lcm-logger.lcm");
  Background logger(
      {"lcm-logger", "--quiet", "--flush-interval=10", "--lcm-url=" + bus_.url(), theirs});
  RecordProcess record(bus_, log_, {"--recv-buffer-mb", "64"});
  ASSERT_TRUE(record.CatchUp("BEGIN", theirs));
  ASSERT_TRUE(record.CatchUp("BEGIN"));
  // WHEN 20000 messages are sent as fast as LCM can
  constexpr std::size_t kMessages = 20'000;
  std::vector<Recorded> sent;
  for (std::size_t i = 0; i < kMessages; ++i) {
    sent.push_back({"BURST_" + std::to_string(i % 7), Payload(i, 200)});
    bus_.Publish(sent.back().channel, sent.back().data);
  }
  ASSERT_TRUE(record.CatchUp("END"));
  ASSERT_TRUE(record.CatchUp("END", theirs));
  const json summary = record.End();
  logger.Signal(SIGINT);
  ASSERT_EQ(logger.Wait(), 0);
  // THEN the recording has all messages in order, and lcm-logger lacks some
  const std::vector<Recorded> recorded = MessagesIn(log_);
  EXPECT_EQ(recorded.size(), kMessages);
  EXPECT_TRUE(recorded == sent);
  EXPECT_EQ(summary["own_overflow"], 0);
  ASSERT_EQ(summary["senders"].size(), 1U);
  EXPECT_EQ(summary["senders"][0]["lost"], 0);
  EXPECT_LT(MessagesIn(theirs).size(), kMessages);
}

TEST_F(RecordTest, NamesTheSenderWhoseMessagesWereLostOnTheWay) {
  RecordProcess record(bus_, log_);
  NumberedSender sender(bus_.url());
  for (const std::uint32_t number : {10U, 11U, 12U, 15U, 16U}) sender.Send(number, "CAMERA");
  ASSERT_TRUE(record.CatchUp("END"));
  const json summary = record.End();
  const auto of_sender = std::ranges::find_if(
      summary["senders"], [&](const json& one) { return one["address"] == sender.Address(); });
  ASSERT_NE(of_sender, summary["senders"].end()) << summary;
  EXPECT_EQ((*of_sender)["received"], 5);
  EXPECT_EQ((*of_sender)["lost"], 2);
}

TEST_F(RecordTest, IsPlayedByLcmLogplayer) {
  RecordProcess record(bus_, log_);
  std::vector<Recorded> sent;
  for (std::size_t i = 0; i < 50; ++i) {
    sent.push_back({"CHANNEL", Payload(i, 10 + i)});
    bus_.Publish(sent.back().channel, sent.back().data);
  }
  ASSERT_TRUE(record.CatchUp("END"));
  record.End();
  runtime::Bus receiver(runtime::FreshMulticastUrl());
  std::vector<Recorded> played;
  receiver.Subscribe("CHANNEL", [&](runtime::Bytes bytes) {
    played.push_back({"CHANNEL", {bytes.begin(), bytes.end()}});
  });
  Background player({"lcm-logplayer", "--lcm-url=" + receiver.url(), log_});
  ASSERT_EQ(player.Wait(), 0) << player.Err();
  while (played.size() < sent.size() && receiver.Wait(kPatience)) {
  }
  EXPECT_TRUE(played == sent);
}

TEST_F(RecordTest, HasMessagesThatAreLargerThanADatagram) {
  RecordProcess record(bus_, log_);
  const std::vector<std::uint8_t> image = Payload(3, 300'000);
  lcm_t* lcm = lcm_create(bus_.url().c_str());
  ASSERT_NE(lcm, nullptr);
  EXPECT_EQ(lcm_publish(lcm, "CAMERA", image.data(), static_cast<unsigned>(image.size())), 0);
  EXPECT_EQ(lcm_publish(lcm, "CAMERA", image.data(), 10), 0);
  ASSERT_TRUE(record.CatchUp("END"));
  lcm_destroy(lcm);
  const json summary = record.End();
  const std::vector<Recorded> recorded = MessagesIn(log_);
  ASSERT_EQ(recorded.size(), 2U);
  EXPECT_EQ(recorded[0].channel, "CAMERA");
  EXPECT_TRUE(recorded[0].data == image);
  EXPECT_EQ(recorded[1].data.size(), 10U);
  EXPECT_EQ(summary["incomplete_messages"], 0);
}

TEST_F(RecordTest, LeavesOutChannelsThatDoNotMatch) {
  RecordProcess record(bus_, log_, {"--channels", "RADAR|LIDAR|MARK_.*"});
  for (const char* channel : {"RADAR", "TRACK", "RADAR2", "LIDAR"}) {
    bus_.Publish(channel, Payload(1, 4));
  }
  ASSERT_TRUE(record.CatchUp("END"));
  const json summary = record.End();
  const std::vector<Recorded> recorded = MessagesIn(log_);
  ASSERT_EQ(recorded.size(), 2U);
  EXPECT_EQ(recorded[0].channel, "RADAR");
  EXPECT_EQ(recorded[1].channel, "LIDAR");
}

TEST_F(RecordTest, BeginsANewFileAtASize) {
  RecordProcess record(bus_, log_, {"--rotate-mb", "0.01"});
  std::vector<Recorded> sent;
  for (std::size_t i = 0; i < 100; ++i) {
    sent.push_back({"CHANNEL", Payload(i, 500)});
    bus_.Publish(sent.back().channel, sent.back().data);
  }
  // The events have 53.5 kB, and a file has at most 10 kB. So the mark is in the sixth file.
  ASSERT_TRUE(record.CatchUp("END", folder_.File("all-005.lcm")));
  const json summary = record.End();
  ASSERT_GE(summary["files"].size(), 6U);
  EXPECT_EQ(summary["files"][0], folder_.File("all-000.lcm"));
  std::vector<Recorded> recorded;
  for (const json& file : summary["files"]) {
    EXPECT_LE(std::filesystem::file_size(file.get<std::string>()), 10'000U);
    std::ranges::move(MessagesIn(file), std::back_inserter(recorded));
  }
  EXPECT_TRUE(recorded == sent);
}

TEST_F(RecordTest, ReplacesNoFileOfAnEarlierRotationWithoutForce) {
  const std::string later = folder_.File("all-002.lcm");
  const std::string other = folder_.File("all-2.lcm");  // not the name of a file of a rotation
  { const RecordProcess record(bus_, later); }
  std::ofstream(other) << "text";
  const std::string before = Content(later);
  std::vector<std::string> command{Program("fogline"), "record", log_,    "--lcm-url", bus_.url(),
                                   "--rotate-mb",      "0.01",   "--for", "0.1"};
  const Outcome outcome = RunCommand(command);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("all-002.lcm: error: LOG: the file exists; --force"));
  EXPECT_FALSE(std::filesystem::exists(folder_.File("all-000.lcm")));
  command.emplace_back("--force");
  EXPECT_EQ(RunCommand(command).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_.File("all-000.lcm")));
  EXPECT_EQ(Content(other), "text");
}

TEST_F(RecordTest, LeavesNoFileOfALongerEarlierRotationIfForced) {
  for (const char* name : {"all-000.lcm", "all-001.lcm", "all-002.lcm"}) {
    const RecordProcess record(bus_, folder_.File(name));
  }
  const std::string other = folder_.File("all-003.txt");
  std::ofstream(other) << "text";
  std::vector<std::string> command{Program("fogline"), "record", log_,    "--lcm-url", bus_.url(),
                                   "--rotate-mb",      "1",      "--for", "0.1",       "--json",
                                   "--force"};
  const Outcome outcome = RunCommand(command);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("removed 2 files of an earlier recording\n"));
  EXPECT_EQ(json::parse(outcome.out)["files"], (json{folder_.File("all-000.lcm")}));
  EXPECT_FALSE(std::filesystem::exists(folder_.File("all-001.lcm")));
  EXPECT_FALSE(std::filesystem::exists(folder_.File("all-002.lcm")));
  EXPECT_EQ(Content(other), "text");
  // If one of the files is not a log, no file is removed.
  std::ofstream(folder_.File("all-001.lcm")) << "text";
  std::ofstream(folder_.File("all-002.lcm")).flush();  // an empty log
  EXPECT_EQ(RunCommand(command).code, 2);
  EXPECT_EQ(Content(folder_.File("all-001.lcm")), "text");
  EXPECT_TRUE(std::filesystem::exists(folder_.File("all-002.lcm")));
}

TEST_F(RecordTest, EndsWithOneErrorAndAValidLogIfTheDiskIsFull) {
  std::unique_ptr<RecordProcess> record;
  {
    const FileSizeLimit full(100'000);
    record = std::make_unique<RecordProcess>(bus_, log_);
  }
  const TimePoint end = Clock::now() + kPatience;
  while (IsAlive(record->process().pid()) && Clock::now() < end) {
    bus_.Publish("CHANNEL", Payload(1, 700));
    bus_.Wait(milliseconds(1));
  }
  EXPECT_EQ(record->process().Wait(), 3);
  const std::string err = record->process().Err();
  EXPECT_THAT(err, HasSubstr("fogline record: error: cannot write to " + log_));
  EXPECT_EQ(err.find("error"), err.rfind("error")) << err;
  // The log has as many whole events as fit. Each event has 700 bytes of data and 35 other bytes.
  EXPECT_EQ(MessagesIn(log_).size(), 100'000U / 735);
}

TEST_F(RecordTest, OfARunIsALogOfThisRun) {
  RecordProcess record(bus_, log_);
  const Outcome run =
      RunCommand({Program("fogline"), "run", "scenario/paper.json", "--json", "--quiet", "--set",
                  "/steps=100", "--log", folder_.File("own.lcm"), "--lcm-url", bus_.url()});
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_TRUE(record.CatchUp("END"));
  const json summary = record.End();
  std::vector<std::string> channels;
  for (const json& one : summary["channels"]) channels.push_back(one["channel"]);
  EXPECT_THAT(channels, IsSupersetOf({"RUN", "TRUTH", "TRACK", "STATUS"}));
  const Outcome digest = RunCommand({Program("fogline"), "digest", log_});
  EXPECT_EQ(digest.code, 0) << digest.err;
  EXPECT_EQ(digest.out.substr(0, digest.out.find(' ')), json::parse(run.out)["digest"]);
}

TEST_F(RecordTest, OfASignedRunIsExportedLikeAnyOther) {
  const std::string key = folder_.File("key");
  runtime::SigningKey::Create(key);
  RecordProcess record(bus_, log_);
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--quiet",
                                  "--set", "/steps=100", "--log", folder_.File("own.lcm"),
                                  "--lcm-url", bus_.url(), "--key", key});
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_TRUE(record.CatchUp("END"));
  record.End();
  const Outcome mcap = RunCommand(
      {Program("fogline"), "export", log_, "--json", "--mcap", folder_.File("run.mcap")});
  ASSERT_EQ(mcap.code, 0) << mcap.err;
  EXPECT_EQ(json::parse(mcap.out)["steps"], 100);
}

TEST_F(RecordTest, FollowsTheRunThatIsAnnounced) {
  // GIVEN a recording that gets no URL, only a meeting address that no other test has
  const std::string meeting = runtime::FreshMulticastUrl();
  Background record({"env", "LCM_DEFAULT_URL=" + meeting, Program("fogline"), "record", log_,
                     "--json", "--flush-ms", "10"});
  ASSERT_TRUE(record.WaitForErr("records "));
  // WHEN a run announces itself at this address
  Background run({"env", "LCM_DEFAULT_URL=" + meeting, Program("fogline"), "run",
                  "scenario/paper.json", "--quiet", "--transport", "udpm", "--pace", "1", "--set",
                  "/steps=10000", "--log", folder_.File("own.lcm")});
  EXPECT_TRUE(record.WaitForErr("follows run "));
  EXPECT_TRUE(ComesToHave("TRACK", log_));
  run.Signal(SIGINT);
  ASSERT_EQ(run.Wait(), 130) << run.Err();
  record.Signal(SIGINT);
  ASSERT_EQ(record.Wait(), 0);
  // THEN the log has messages of this run
  const std::vector<Recorded> recorded = MessagesIn(log_);
  EXPECT_TRUE(std::ranges::any_of(
      recorded, [](const Recorded& message) { return message.channel == "TRACK"; }));
}

TEST_F(RecordTest, GoesOnWhenTheRelayOfAFollowedRunHasEnded) {
  const std::string meeting = runtime::FreshMulticastUrl();
  Background record({"env", "LCM_DEFAULT_URL=" + meeting, Program("fogline"), "record", log_,
                     "--flush-ms", "10"});
  ASSERT_TRUE(record.WaitForErr("records "));
  Background run({"env", "LCM_DEFAULT_URL=" + meeting, Program("fogline"), "run",
                  "scenario/paper.json", "--quiet", "--transport", "tcpq", "--pace", "1", "--set",
                  "/steps=10000", "--log", folder_.File("own.lcm")});
  EXPECT_TRUE(record.WaitForErr("follows run "));
  run.Signal(SIGINT);
  ASSERT_EQ(run.Wait(), 130) << run.Err();
  // The relay of the run ends with the run. The recording tries for some time to connect to the
  // relay again, and then leaves it.
  EXPECT_TRUE(record.WaitForErr("leaves tcpq://")) << record.Err();
  runtime::Bus(meeting).Publish("AFTERWARDS", Payload(1, 4));
  record.Signal(SIGINT);
  ASSERT_EQ(record.Wait(), 0) << record.Err();
  const std::vector<Recorded> recorded = MessagesIn(log_);
  ASSERT_FALSE(recorded.empty());
  EXPECT_EQ(recorded.back().channel, "AFTERWARDS");
}

TEST_F(RecordTest, SaysWhenTheRelayIsLostAndWhenItIsBack) {
  const auto start = [](const std::string& address) {
    return std::make_unique<Background>(
        std::vector<std::string>{Program("fogline-relay"), "--listen", address});
  };
  std::unique_ptr<Background> relay = start("127.0.0.1:0");
  ASSERT_TRUE(relay->WaitForOut("\n"));
  const std::string url = relay->Out().substr(0, relay->Out().find('\n'));
  runtime::Bus bus(url);
  RecordProcess record(bus, log_);
  relay->Signal(SIGKILL);
  relay->Wait();
  EXPECT_TRUE(record.process().WaitForErr("warning: lost the relay " + url + ": "))
      << record.process().Err();
  relay = start(url.substr(std::string("tcpq://").size()));
  EXPECT_TRUE(record.process().WaitForErr("records " + url + " again\n")) << record.process().Err();
  EXPECT_TRUE(record.CatchUp("END"));
  record.End();
}

TEST_F(RecordTest, CountsNoLossesOnANetworkWithoutNumbers) {
  Background relay({Program("fogline-relay"), "--listen", "127.0.0.1:0"});
  ASSERT_TRUE(relay.WaitForOut("\n"));
  const std::string url = relay.Out().substr(0, relay.Out().find('\n'));
  const std::vector<std::string> command{Program("fogline"), "record", "--force", log_,
                                         "--lcm-url",        url,      "--for",   "0.1"};
  const Outcome text = RunCommand(command);
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, Not(HasSubstr("lost")));
  std::vector<std::string> with_json = command;
  with_json.emplace_back("--json");
  EXPECT_EQ(json::parse(RunCommand(with_json).out)["senders"], nullptr);
}

TEST_F(RecordTest, SaysWhatIsWrongWithItsArguments) {
  const auto error = [&](std::vector<std::string> more) {
    std::vector<std::string> command{Program("fogline"), "record", log_};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_THAT(error({"--channels", "RADAR("}),
              HasSubstr("error: --channels RADAR(: no regular expression: "));
  EXPECT_THAT(error({"--lcm-url", "memq://"}), HasSubstr("memq"));
  EXPECT_THAT(error({"--lcm-url", "udpm://10.0.0.1:7700"}), HasSubstr("10.0.0.1"));
  EXPECT_FALSE(std::filesystem::exists(log_));
  std::ofstream(log_) << "text";
  EXPECT_THAT(error({}), HasSubstr("all.lcm: error: LOG: the file exists; --force replaces it"));
  EXPECT_THAT(error({"--force"}), HasSubstr("is no event log and is not replaced"));
  const Outcome device = RunCommand({Program("fogline"), "record", "/dev/stdout", "--for", "0.1"});
  EXPECT_EQ(device.code, 2);
  EXPECT_THAT(device.err,
              HasSubstr("/dev/stdout: error: LOG: this path names a pipe, a device or"));
}

}  // namespace
}  // namespace fogline::test
