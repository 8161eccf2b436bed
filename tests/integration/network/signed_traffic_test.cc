// A process has no effect on a signed run if it has no key or another key, or if it sends copies of
// other processes' messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <limits>
#include <map>
#include <set>
#include <thread>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/runs/paper_run.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using Payload = std::vector<std::uint8_t>;

/// Receives all traffic of a network and publishes arbitrary messages. The intruder has no key.
class Intruder {
 public:
  explicit Intruder(const std::string& url) : bus_(url) {
    for (const ChannelInfo& channel : kChannels) {
      bus_.Subscribe(channel.name, [this, name = std::string(channel.name)](runtime::Bytes bytes) {
        if (bytes.size() >= runtime::kHeaderEnd) Hear(name, bytes);
      });
    }
  }

  /// AccompanyUntilTheEnd() listens until the run has ended, and calls this function with every
  /// message. AccompanyUntilTheEnd() skips repeated messages, messages of `other_runs`, and the
  /// intruder's own messages.
  using Answer = std::function<void(const std::string& channel, const Payload& message)>;
  void AccompanyUntilTheEnd(const Background& run, const std::set<std::int64_t>& other_runs,
                            const Answer& answer) {
    std::size_t done = 0;
    for (bool alive = true; alive;) {
      alive = IsAlive(run.pid());  // the messages that have come until then are handled, too
      if (bus_.Wait(alive ? milliseconds(20) : milliseconds(0))) bus_.Drain();
      for (; done < heard_.size(); ++done) {
        const auto [channel, message] = heard_[done];
        if (!said_.contains(message) && !other_runs.contains(RunIdOf(message))) {
          answer(channel, message);
        }
      }
    }
  }

  void Say(const std::string& channel, const Payload& message) {
    if (message.size() > runtime::kMaxMessageBytes) return;
    said_.insert(message);
    bus_.Publish(channel, message);
    ++count_;
  }

  const std::vector<std::pair<std::string, Payload>>& heard() const { return heard_; }
  int count() const { return count_; }

  static std::int64_t RunIdOf(runtime::Bytes message) {
    return runtime::ReadInt64(message, runtime::kRunIdOffset);
  }

 private:
  void Hear(const std::string& channel, runtime::Bytes bytes) {
    Payload message(bytes.begin(), bytes.end());
    if (known_.insert(message).second) heard_.emplace_back(channel, std::move(message));
  }

  runtime::Bus bus_;
  std::set<Payload> known_;
  std::set<Payload> said_;
  std::vector<std::pair<std::string, Payload>> heard_;
  int count_ = 0;
};

/// The message with other contents and a later step. The receivers still wait for this step.
Payload Forged(Payload payload) {
  constexpr std::uint8_t kStepsAhead = 3;
  payload[runtime::kStepOffset + 7] =
      static_cast<std::uint8_t>(payload[runtime::kStepOffset + 7] + kStepsAhead);
  payload.back() ^= 1;
  return payload;
}

Payload Copy(runtime::Bytes bytes) { return {bytes.begin(), bytes.end()}; }

class SignedTrafficTest : public testing::Test {
 protected:
  SignedTrafficTest() {
    for (const std::string& file : {key_, other_key_}) runtime::SigningKey::Create(file);
  }

  std::vector<std::string> Run(const std::vector<std::string>& more) {
    return PaperRun(url_, folder_.File(std::to_string(++logs_) + ".lcm"), more);
  }
  static nlohmann::json ResultOf(Background& run) {
    EXPECT_EQ(run.Wait(), 0) << run.Err();
    return nlohmann::json::parse(run.Out(), nullptr, false);
  }
  std::string Undisturbed(const std::string& steps) {
    const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--json",
                                    "--transport", "direct", "--set", steps});
    return nlohmann::json::parse(run.out)["digest"];
  }

  ScratchFolder folder_;
  const std::string key_ = folder_.File("key");
  const std::string other_key_ = folder_.File("other_key");
  const std::string url_ = runtime::Bus(runtime::FreshMulticastUrl()).url();

 private:
  int logs_ = 0;
};

TEST_F(SignedTrafficTest,
       UnsignedWronglySignedAlteredAndReplayedMessagesHaveNoEffectAndAreCounted) {
  Intruder intruder(url_);
  // GIVEN all messages of an earlier run with the same key
  Background earlier(Run({"--key", key_, "--set", "/steps=30"}));
  intruder.AccompanyUntilTheEnd(earlier, {}, [](const std::string&, const Payload&) {});
  ResultOf(earlier);
  const auto recorded = intruder.heard();
  ASSERT_GT(recorded.size(), 300U);
  const std::int64_t earlier_id = Intruder::RunIdOf(recorded.front().second);
  // WHEN an intruder answers every message of a run with forgeries, including a STOP
  runtime::MessageSigner wrong_key(runtime::SigningKey::Load(other_key_), std::nullopt);
  runtime::MessageSigner wrong_sender(runtime::SigningKey::Load(key_), Role::kLidar);
  std::size_t next = 0;
  Background run(Run({"--key", key_, "--set", "/steps=60", "--pace", "3"}));
  intruder.AccompanyUntilTheEnd(run, {earlier_id},
                                [&](const std::string& channel, const Payload& message) {
                                  const Payload payload = Copy(runtime::WithoutSignature(message));
                                  Payload forged = Forged(payload);
                                  if (channel == "RUN") forged[runtime::kHeaderEnd] = run_t::STOP;
                                  Payload altered = message;
                                  altered[payload.size() - 1] ^= 1;
                                  for (const Payload& attack : {forged, altered, message})
                                    intruder.Say(channel, attack);
                                  intruder.Say(channel, Copy(wrong_key.Sign(channel, forged)));
                                  if (channel != "LIDAR" && channel != "RESEND") {
                                    intruder.Say(channel, Copy(wrong_sender.Sign(channel, forged)));
                                  }
                                  intruder.Say(recorded[next].first, recorded[next].second);
                                  next = (next + 1) % recorded.size();
                                });
  // THEN the run reaches its end undisturbed
  const auto result = ResultOf(run);
  EXPECT_GT(intruder.count(), 2000);
  EXPECT_EQ(result["steps"], 60);
  EXPECT_EQ(result["digest"], Undisturbed("/steps=60"));
  // AND the run has counted each kind of forgery
  EXPECT_GT(result["refused"]["not_signed"], 500);
  EXPECT_GT(result["refused"]["badly_signed"], 1000);
  EXPECT_GT(result["refused"]["foreign"], 100);
  EXPECT_EQ(result["refused"]["malformed"], 0);
}

TEST_F(SignedTrafficTest, ARoleFromElsewhereTakesNoPartInARunThatIsReplayed) {
  Intruder intruder(url_);
  // GIVEN all RUN messages of an earlier run with the same key
  Background earlier(Run({"--key", key_, "--set", "/steps=30"}));
  intruder.AccompanyUntilTheEnd(earlier, {}, [](const std::string&, const Payload&) {});
  ResultOf(earlier);
  std::vector<Payload> announcements;
  for (const auto& [channel, message] : intruder.heard()) {
    if (channel == "RUN") announcements.push_back(message);
  }
  ASSERT_GT(announcements.size(), 3U);
  const std::int64_t earlier_id = Intruder::RunIdOf(announcements.front());
  const auto replay = [&] {
    for (const Payload& message : announcements) intruder.Say("RUN", message);
  };
  // WHEN the RUN messages of the earlier run are replayed for 1 s to a driver that waits for a run
  Background driver({Program("fogline-driver"), "--lcm-url", url_, "--key", key_});
  for (int i = 0; i < 50; ++i) {
    replay();
    ASSERT_TRUE(IsAlive(driver.pid())) << "it took part";
    std::this_thread::sleep_for(milliseconds(20));
  }
  // THEN the driver takes part in the next genuine run
  Background run(Run({"--key", key_, "--external", "driver", "--set", "/steps=30"}));
  intruder.AccompanyUntilTheEnd(run, {earlier_id},
                                [&](const std::string&, const Payload&) { replay(); });
  EXPECT_EQ(ResultOf(run)["digest"], Undisturbed("/steps=30"));
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST_F(SignedTrafficTest, UnsoundMessagesHaveNoEffectOnAnUnsignedRunEither) {
  Intruder intruder(url_);
  lcm_t* lcm = lcm_create(url_.c_str());
  ASSERT_NE(lcm, nullptr);
  Background run(Run({"--set", "/steps=60", "--pace", "1"}));
  intruder.AccompanyUntilTheEnd(run, {}, [&](const std::string& channel, const Payload& message) {
    const auto* info = std::ranges::find(kChannels, channel, &ChannelInfo::name);
    if (info->pace != Pace::kStep) return;
    Payload other_type = Forged(message);
    other_type[0] ^= 1;
    Payload too_long = Forged(message);
    too_long.push_back(0);
    intruder.Say(channel, other_type);
    intruder.Say(channel, too_long);
    if (channel == "ACC_COMMAND") {
      accel_command_t command{};
      ASSERT_TRUE(runtime::Decode(message, command));
      command.header.step += 3;
      command.acceleration_mps2 = std::numeric_limits<double>::quiet_NaN();
      Payload nan;
      runtime::Encode(command, nan);
      intruder.Say(channel, nan);
      // This message is sent in fragments. The kernel's filter drops them.
      const Payload huge(300'000, 1);
      lcm_publish(lcm, channel.c_str(), huge.data(), static_cast<unsigned>(huge.size()));
    }
  });
  lcm_destroy(lcm);
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed("/steps=60"));
  EXPECT_GT(result["refused"]["wrong_type"], 500);
  EXPECT_GT(result["refused"]["malformed"], 500);
  EXPECT_GT(result["refused"]["not_finite"], 50);
}

TEST_F(SignedTrafficTest, NamesProcessesThatHaveAnotherKeyOrNone) {
  // GIVEN a run that waits for a driver
  Background run(Run({"--key", key_, "--external", "driver"}));
  const auto driver = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command{Program("fogline-driver"), "--lcm-url", url_};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  };
  // WHEN two drivers start that cannot take part, THEN each driver says why
  Background keyless(driver({}));
  EXPECT_TRUE(keyless.WaitForErr("fogline-driver: traffic on this network is signed; give --key"));
  Background other(driver({"--key", other_key_, "--run-id", "7"}));
  EXPECT_TRUE(
      other.WaitForErr("with a wrong signature were refused: do all processes have the "
                       "same key?"));
  // AND the runner reports the messages with a wrong signature, while it waits and at its end
  EXPECT_TRUE(run.WaitForErr("with a wrong signature were refused"));
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130);
  EXPECT_THAT(run.Err(), HasSubstr("driver (never heard)"));
  EXPECT_THAT(run.Err(), HasSubstr("with a wrong signature were refused"));
}

TEST_F(SignedTrafficTest, TellsARunnerWithoutAKeyThatTheTrafficIsSigned) {
  Background run(Run({"--external", "driver"}));
  ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
  Background driver({"env", "FOGLINE_KEY=" + key_, Program("fogline-driver"), "--lcm-url", url_,
                     "--run-id", "7"});
  EXPECT_TRUE(run.WaitForErr("warning: traffic on this network is signed; give --key"));
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130);
}

TEST_F(SignedTrafficTest, TakesTheKeyFromTheEnvironment) {
  Intruder intruder(url_);
  Background run([&] {
    std::vector<std::string> command = Run({"--set", "/steps=20"});
    command.insert(command.begin(), {"env", "FOGLINE_KEY=" + key_});
    return command;
  }());
  bool signed_steps = false;
  intruder.AccompanyUntilTheEnd(run, {}, [&](const std::string& channel, const Payload& message) {
    signed_steps = signed_steps || (channel == "TRUTH" && runtime::LooksSigned(message));
  });
  EXPECT_EQ(ResultOf(run)["digest"], Undisturbed("/steps=20"));
  EXPECT_TRUE(signed_steps);
}

TEST_F(SignedTrafficTest, RefusesAFileThatIsNoKeyOrThatOthersCanRead) {
  const Outcome none = RunCommand(Run({"--key", "scenario/paper.json"}));
  EXPECT_EQ(none.code, 2);
  EXPECT_EQ(none.err,
            "scenario/paper.json: error: not a key, which is 64 hexadecimal digits and nothing "
            "else; `fogline keygen FILE` makes one\n");
  EXPECT_EQ(RunCommand({Program("fogline-acc"), "--key", "no/such/file"}).code, 2);
  EXPECT_EQ(RunCommand({Program("fogline"), "keygen", key_}).code, 2) << "it exists";
  std::filesystem::permissions(key_, std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  const Outcome open = RunCommand(Run({"--key", key_, "--set", "/steps=5"}));
  EXPECT_EQ(open.code, 2);
  EXPECT_EQ(open.err, key_ + ": error: others can read or change this key (mode 604); chmod 600 " +
                          key_ + "\n");
}

TEST_F(SignedTrafficTest, NeverRunsUnsignedOrLooksAwayWhenAKeyWasAskedFor) {
  for (const char* transport : {"direct", "memq"}) {
    const std::vector<std::string> run{Program("fogline"), "run",     "scenario/paper.json",
                                       "--transport",      transport, "--log",
                                       folder_.File("no"), "--set",   "/steps=5"};
    const auto with = [&run](const std::vector<std::string>& more) {
      std::vector<std::string> command = run;
      command.insert(command.end(), more.begin(), more.end());
      return command;
    };
    const Outcome empty = RunCommand(with({"--key", ""}));
    EXPECT_EQ(empty.code, 2);
    EXPECT_THAT(empty.err, HasSubstr("--key: the text is empty"));
    const Outcome missing = RunCommand(with({"--key", "no/such/file"}));
    EXPECT_EQ(missing.code, 2);
    EXPECT_EQ(missing.err, "no/such/file: error: cannot read the key: No such file or directory\n");
    std::vector<std::string> command = with({});
    command.insert(command.begin(), {"env", "FOGLINE_KEY="});
    const Outcome variable = RunCommand(command);
    EXPECT_EQ(variable.code, 2);
    EXPECT_THAT(variable.err, HasSubstr("error: FOGLINE_KEY is empty"));
  }
  EXPECT_EQ(RunCommand({Program("fogline-acc"), "--key", ""}).code, 2);
  EXPECT_EQ(RunCommand({"env", "FOGLINE_KEY=", Program("fogline-acc")}).code, 2);
}

}  // namespace
}  // namespace fogline::test
