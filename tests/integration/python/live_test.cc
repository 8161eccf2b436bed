// fl.Live (in the Python package fogline_lab) listens to a run that announces itself, over any
// transport.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/integration/network/meeting.h"
#include "tests/integration/python/python.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

// This script prints "joined" after the first message. After the message of the last step, the
// script prints the number of the received steps of TRUTH, the first step, the last step, and the
// counts of refused messages.
constexpr const char* kListener = R"(
import fogline_lab as fl

steps = set()
with fl.Live() as live:
    print("listening", flush=True)
    joined = False
    for channel, message in live:
        if not joined:
            print("joined", flush=True)
            joined = True
        if channel == "TRUTH":
            steps.add(message.header.step)
            if message.last:
                break
    print(len(steps), min(steps), max(steps), dict(live.refused))
)";

class LiveTest : public testing::Test {
 protected:
  /// Expects that a listener without a URL gets each step of a run with the options `of_run`. The
  /// driver of the run gets the options `of_driver`. The run waits for its driver, and the driver
  /// starts only after the listener has joined the network of the run.
  void ExpectHears(const std::vector<std::string>& of_run,
                   const std::vector<std::string>& of_driver = {}) {
    std::vector<std::string> listener = Python(WriteScript(folder_, kListener), {});
    listener.insert(listener.begin() + 1, "LCM_DEFAULT_URL=" + meeting_.url());
    Background live(listener);
    ASSERT_TRUE(live.WaitForOut("listening")) << live.Err();
    // The run is slow, so no message is lost even if a busy machine delays the listener.
    std::vector<std::string> more{"--external", "driver", "--pace", "1", "--set", "/steps=40"};
    more.insert(more.end(), of_run.begin(), of_run.end());
    Background run(meeting_.Run(more));
    ASSERT_TRUE(live.WaitForOut("joined")) << live.Err() << run.Err();
    Background driver(meeting_.Command("fogline-driver", of_driver));
    EXPECT_EQ(run.Wait(), 0) << run.Err();
    EXPECT_EQ(live.Wait(), 0) << live.Err();
    EXPECT_THAT(live.Out(), HasSubstr("\n40 0 39 {}\n"));
  }

  ScratchFolder folder_;
  Meeting meeting_;
};

TEST_F(LiveTest, HearsEachStepOfARunOnItsOwnPort) {
  ExpectHears({"--lcm-url", runtime::FreshMulticastUrl()});
}

TEST_F(LiveTest, HearsEachStepOfARunOverARelay) { ExpectHears({"--transport", "tcpq"}); }

TEST_F(LiveTest, HearsEachStepOfASignedRunAtTheMeetingAddress) {
  const std::string key = folder_.File("key");
  runtime::SigningKey::Create(key);
  ExpectHears({"--key", key}, {"--key", key});
}

TEST_F(LiveTest, EndsWhenNothingComesAnyMore) {
  const std::string script = WriteScript(folder_,
                                         "import fogline_lab as fl, sys\n"
                                         "print(list(fl.Live(sys.argv[1], timeout_s=0.3)))\n");
  const Outcome outcome = RunCommand(Python(script, {runtime::FreshMulticastUrl()}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "[]\n");
}

TEST_F(LiveTest, SaysWhichRelayIsMissing) {
  const std::string script =
      WriteScript(folder_, "import fogline_lab as fl\nfl.Live('tcpq://127.0.0.1:1')\n");
  const Outcome outcome = RunCommand(Python(script, {}));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("FoglineError: no relay at 127.0.0.1:1: Connection refused"));
}

}  // namespace
}  // namespace fogline::test
