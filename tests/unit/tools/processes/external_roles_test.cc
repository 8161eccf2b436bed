#include "tools/processes/external_roles.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "tests/unit/services/runtime/script.h"

namespace fogline::test {
namespace {

using processes::ExternalRoles;
using Phase = runtime::RunCoordinator::Phase;

const std::string kUrl = "udpm://239.255.76.67:7700?ttl=0";

ExternalRoles With(Duration limit, const std::string& key = "") {
  return ExternalRoles(kUrl, {.key_file = key, .faults = ""}, limit);
}

TEST(ExternalRolesTest, SayHowLongTheRunWaits) {
  EXPECT_EQ(With(milliseconds(7250)).Limit(), "7.25 s");
  EXPECT_EQ(With(Duration::zero()).Limit(), "for ever");
}

TEST(ExternalRolesTest, NameTheCommandThatStartsARoleOfThisRun) {
  EXPECT_EQ(With(milliseconds(1)).Command(Role::kDriver),
            "fogline-driver --lcm-url '" + kUrl + "'");
  EXPECT_EQ(With(milliseconds(1), "my key").Command(Role::kAcc),
            "fogline-acc --lcm-url '" + kUrl + "' --key 'my key'");
}

TEST(ExternalRolesTest, ShareOneLineHoweverManyTheyAre) {
  const ExternalRoles roles = With(milliseconds(60'000));
  EXPECT_EQ(roles.Text({Role::kDriver}),
            "waiting for the driver (60 s): start it with: " + roles.Command(Role::kDriver));
  EXPECT_EQ(roles.Text({Role::kAcc, Role::kDriver}),
            "waiting for the acc, the driver (60 s): start each with: fogline-ROLE --lcm-url '" +
                kUrl + "'");
  EXPECT_EQ(roles.Text({}), "");
}

/// The coordinator of a run that waits for driver and acc.
class AwaitedRolesTest : public testing::Test {
 protected:
  Script script_;
  runtime::RunCoordinator coordinator_{script_.bus(),
                                       {.run_id = Script::kRunId,
                                        .scenario_text = script_.text(),
                                        .external = {Role::kDriver, Role::kAcc}}};
};

TEST_F(AwaitedRolesTest, EndTheRunByNameAfterTheLimit) {
  const ExternalRoles roles = With(milliseconds(10'000));
  const TimePoint began = Clock::now();
  roles.Check(coordinator_, began + milliseconds(9'000));
  EXPECT_EQ(coordinator_.phase(), Phase::kJoining);
  roles.Check(coordinator_, began + milliseconds(11'000));
  EXPECT_EQ(coordinator_.phase(), Phase::kFailed);
  EXPECT_EQ(coordinator_.error(), "waited 10 s for the acc, the driver in vain; start with: " +
                                      roles.Command(Role::kAcc) + " and " +
                                      roles.Command(Role::kDriver) + " (--wait 0 waits for ever)");
}

TEST_F(AwaitedRolesTest, AreNamedWhenTheyComeAndWhenTheyGo) {
  ExternalRoles roles = With(milliseconds(10'000));
  const std::vector<Role> external{Role::kAcc, Role::kDriver};
  const auto news = [&] { return roles.News(external, coordinator_, Clock::now()); };
  EXPECT_EQ(news(), "");
  auto status = Script::Of<status_t>(-1);
  status.role = "driver";
  status.host = "lab2";
  status.pid = 4711;
  status.instance = 1;
  status.sequence = 1;
  status.state = status_t::READY;
  status.scenario_hash = runtime::HashOf(script_.text());
  status.type_fingerprint = TypeFingerprint();
  script_.Say(status);
  EXPECT_EQ(news(), "the driver has come (pid 4711 on lab2); missing: the acc");
  EXPECT_EQ(news(), "") << "it is said once";
  status.state = status_t::LEFT;
  ++status.sequence;
  script_.Say(status);
  EXPECT_EQ(news(), "the driver has gone; missing: the acc, the driver");
}

TEST_F(AwaitedRolesTest, AreAwaitedForEverWithoutALimit) {
  With(Duration::zero()).Check(coordinator_, Clock::now() + std::chrono::hours(24));
  EXPECT_EQ(coordinator_.phase(), Phase::kJoining);
}

TEST_F(AwaitedRolesTest, AreGivenTheTimeInWhichTheRunnerWasHeldUp) {
  const ExternalRoles roles = With(milliseconds(10'000));
  const TimePoint back = Clock::now() + milliseconds(60'000);
  coordinator_.Attend(back);
  roles.Check(coordinator_, back);
  EXPECT_EQ(coordinator_.phase(), Phase::kJoining);
}

TEST_F(AwaitedRolesTest, AreNotAwaitedByARunThatIsOver) {
  coordinator_.Fail("of another reason");
  With(milliseconds(1)).Check(coordinator_, Clock::now() + milliseconds(60'000));
  EXPECT_EQ(coordinator_.error(), "of another reason");
}

}  // namespace
}  // namespace fogline::test
