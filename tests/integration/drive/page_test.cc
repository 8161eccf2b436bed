// `fogline drive` with the page /drive: the verb, fogline-web and the whole run. In place of the
// page, the test connects to the WebSocket and sends what the page would send.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/log/run_log.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/drive/driven_run.h"
#include "tests/integration/drive/page_person.h"
#include "tests/integration/web/viewed.h"
#include "tests/unit/tools/trials/desk/taken_port.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

std::uint16_t PortIn(const std::string& err) {
  constexpr std::string_view kBefore = "drive: http://127.0.0.1:";
  const std::size_t at = err.find(kBefore);
  if (at == std::string::npos) return 0;
  return static_cast<std::uint16_t>(std::stoi(err.substr(at + kBefore.size())));
}

std::vector<std::string> DriveAtPage(const std::string& log, std::vector<std::string> more = {}) {
  more.insert(more.begin(),
              {"env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", Program("fogline"), "drive",
               kDriveScenario, "--json", "--log", log, "--lcm-url", runtime::FreshMulticastUrl()});
  for (const std::string& setting : AlwaysAskedAtAPage()) {
    more.push_back("--set");
    more.push_back(setting);
  }
  return more;
}

TEST(DriveAtPageInRealtimeTest, TheRunBeginsWithThePersonAndIsDrivenByTheirInputs) {
  const ScratchFolder folder;
  const std::string log = folder.File("drive.lcm");
  Background run(DriveAtPage(log, {"--set", "/steps=500"}));
  ASSERT_TRUE(run.WaitForErr("view: http://127.0.0.1:", kPatience)) << run.Err();
  EXPECT_THAT(run.Err(), HasSubstr("/drive\n"));
  const PagePerson person(PortIn(run.Err()));
  EXPECT_EQ(run.Wait(), 0) << run.Err();
  // The driver has used the inputs, and the person has got authority.
  log::RunLogReader reader(log);
  std::int64_t of_person = 0;
  std::int64_t human = 0;
  while (const log::StepMessages* step = reader.Next()) {
    driver_command_t command;
    arbitration_t host;
    // In real time a message of a step may be missing.
    if (!runtime::Decode((*step)[IndexOf<driver_command_t>()], command)) continue;
    if (!runtime::Decode((*step)[IndexOf<arbitration_t>()], host)) continue;
    of_person += command.input_sequence >= 0 ? 1 : 0;
    human += host.lambda_human > 0 ? 1 : 0;
  }
  EXPECT_GT(of_person, 100);
  EXPECT_GT(human, 50);
}

TEST(DriveAtPageTest, CtrlCEndsTheWaitForThePerson) {
  const ScratchFolder folder;
  Background run(DriveAtPage(folder.File("drive.lcm")));
  ASSERT_TRUE(run.WaitForErr("view: http://127.0.0.1:", kPatience)) << run.Err();
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130) << run.Err();
}

TEST(DriveAtPageTest, ForOthersBothAddressesHaveTokens) {
  const ScratchFolder folder;
  Background run(DriveAtPage(folder.File("drive.lcm"), {"--listen", "127.0.0.1:0"}));
  ASSERT_TRUE(run.WaitForErr("view: http://127.0.0.1:", kPatience)) << run.Err();
  EXPECT_THAT(run.Err(), HasSubstr("/drive#token="));
  EXPECT_THAT(run.Err(), HasSubstr("/#token="));
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130) << run.Err();
}

TEST(DriveAtPageTest, RefusesOptionsOfThePageWithAnotherDevice) {
  for (const char* option : {"--listen=127.0.0.1", "--no-browser"}) {
    const Outcome outcome =
        RunCommand({Program("fogline"), "drive", kDriveScenario, "--evdev", "/dev/null", option});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("excludes"));
  }
}

TEST(DriveAtPageTest, RefusesWhatNoDriveCanFollowBeforeItBegins) {
  const auto error_of = [](const std::string& option, const std::string& value) {
    const Outcome outcome =
        RunCommand({Program("fogline"), "drive", kDriveScenario, option, value});
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_EQ(error_of("--set", "/person/drives=false"),
            "fogline drive: error: --set /person/drives=false: in this verb a person drives\n");
  // RFC 5737 reserves 203.0.113.0/24 for examples, so no machine has an address of it.
  EXPECT_EQ(
      error_of("--listen", "203.0.113.7"),
      "fogline drive: error: --listen: 203.0.113.7 is no address of this machine (`ip address` "
      "lists them)\n");
  TakenPort taken(0);
  ASSERT_TRUE(taken.Take());
  const std::string place = "127.0.0.1:" + std::to_string(taken.port());
  EXPECT_EQ(error_of("--listen", place), "fogline drive: error: --listen: cannot listen on " +
                                             place + ": Address already in use\n");
  EXPECT_EQ(error_of("--faults", "flip=0.1").rfind("fogline drive: error: --faults: ", 0), 0U);
  EXPECT_EQ(error_of("--transport", "direct"),
            "fogline drive: error: --transport direct: all roles are in one process; a run in "
            "real time needs a process for each role\n");
}

}  // namespace
}  // namespace fogline::test
