#include "tools/replay/role_check.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "services/runtime/wire/wire.h"
#include "tests/support/copied_log.h"
#include "tests/support/input_errors.h"
#include "tests/unit/tools/short_run.h"
#include "tools/processes/child.h"

namespace fogline::test {
namespace {

using replay::MakeRoleReplay;
using replay::RoleCheck;
using replay::Verification;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::int64_t kSteps = 40;
constexpr std::int64_t kAltered = 23;
constexpr std::size_t kComputing = kRoles.size() - 1;  // all roles except the recorder

/// The log of a run, and a copy in which a message of one step is altered.
class RoleCheckTest : public testing::Test {
 protected:
  RoleCheckTest() { runner::RunScenario(Paper(kSteps), Direct(log_)); }

  /// Alters the message of type M of a step in the copy.
  template <class M, class Change>
  void Alter(const Change& change, std::int64_t step = kAltered) {
    const std::string before = folder_.File("before.lcm");
    std::filesystem::copy_file(std::filesystem::exists(altered_) ? altered_ : log_, before,
                               std::filesystem::copy_options::overwrite_existing);
    Copy(before, altered_,
         [&](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>& data) {
           M message{};
           if (event.channel == ChannelOf<M>().name && runtime::Decode(data, message) &&
               message.header.step == step) {
             change(message);
             runtime::Encode(message, data);
           }
           return true;
         });
  }
  static std::vector<RoleCheck> Check(const std::string& log) {
    const log::RunLog run = ReadToTheEnd(log);
    std::vector<RoleCheck> roles = replay::MakeRoleChecks(run);
    log::RunLogReader reader(log);
    replay::CheckRoles(reader, roles);
    return roles;
  }
  static Verification Verify(const std::string& log,
                             const std::vector<runtime::OtherBuild>& others = {}) {
    return replay::VerifyRun(log, ReadToTheEnd(log), others);
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string altered_ = folder_.File("altered.lcm");
};

TEST_F(RoleCheckTest, ComputesEveryStepOfEveryRoleAgain) {
  const std::vector<RoleCheck> roles = Check(log_);
  EXPECT_THAT(roles, SizeIs(kComputing));
  for (const RoleCheck& one : roles) {
    EXPECT_EQ(one.steps_that_differ, 0) << NameOf(one.role);
    EXPECT_FALSE(one.first) << NameOf(one.role);
  }
}

TEST_F(RoleCheckTest, FindsTheStepInWhichARoleDiffersAndNoOther) {
  Alter<driver_command_t>([](driver_command_t& command) { command.acceleration_mps2 = 9; });
  for (const RoleCheck& one : Check(altered_)) {
    if (one.role == Role::kArbitrator) continue;  // the arbitrator reads the altered message
    EXPECT_EQ(one.steps_that_differ, one.role == Role::kDriver ? 1 : 0) << NameOf(one.role);
    if (one.role != Role::kDriver) continue;
    ASSERT_TRUE(one.first);
    EXPECT_EQ(one.first->step, kAltered);
    EXPECT_EQ(one.first->channel, "DRIVER_COMMAND");
    EXPECT_EQ(one.first->field, "acceleration_mps2");
    EXPECT_EQ(one.first->a, "9");
    EXPECT_NE(one.first->b, "9");
  }
}

TEST_F(RoleCheckTest, RefusesAMessageThatARoleCannotRead) {
  Alter<radar_t>([](radar_t& radar) { radar.range_m = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_EQ(ErrorOf([&] { Check(altered_); }),
            "step 23: the RADAR in the log is not a message of its type, or has a value that "
            "is not finite");
}

TEST_F(RoleCheckTest, HasNoReplayOfARoleThatComputesNothing) {
  const log::RunLog run = ReadToTheEnd(log_);
  EXPECT_EQ(MakeRoleReplay(Role::kRecorder, run), nullptr);
  EXPECT_EQ(MakeRoleReplay(Role::kRunner, run), nullptr);
  EXPECT_NE(MakeRoleReplay(Role::kWorld, run), nullptr);
}

TEST_F(RoleCheckTest, ComputesOneRoleStepByStep) {
  const auto replay = MakeRoleReplay(Role::kFusion, ReadToTheEnd(log_));
  log::RunLogReader reader(log_);
  const log::StepMessages* const first = reader.Next();
  ASSERT_NE(first, nullptr);
  EXPECT_FALSE(replay->Step(0, *first, {}));
  const log::StepMessages before = *first;
  const log::StepMessages* const second = reader.Next();
  ASSERT_NE(second, nullptr);
  log::StepMessages lacks_track = *second;
  lacks_track[IndexOf<track_t>()] = {};
  const auto difference = replay->Step(1, lacks_track, before);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "(message)");
  EXPECT_EQ(difference->a, "none");
}

TEST_F(RoleCheckTest, AVerificationHoldsForALogAsItWasMade) {
  const Verification verification = Verify(log_);
  EXPECT_TRUE(verification.Holds());
  EXPECT_EQ(verification.Trouble(), "");
  EXPECT_THAT(verification.roles, SizeIs(kComputing));
  EXPECT_THAT(verification.left_out, IsEmpty());
}

TEST_F(RoleCheckTest, AVerificationNamesTheEarliestDifference) {
  Alter<accel_command_t>([](accel_command_t& command) { command.acceleration_mps2 = 9; },
                         kAltered + 5);
  Alter<driver_command_t>([](driver_command_t& command) { command.acceleration_mps2 = 8; });
  const Verification verification = Verify(altered_);
  EXPECT_FALSE(verification.Holds());
  ASSERT_TRUE(verification.failure);
  EXPECT_EQ(verification.failure->role, Role::kDriver);
  EXPECT_EQ(verification.failure->first.step, kAltered);
  EXPECT_EQ(verification.Trouble(),
            "step 23: DRIVER_COMMAND of driver: acceleration_mps2 is 8 in the log, and " +
                verification.failure->first.b +
                " when it is computed again: was it altered on its way?");
}

TEST_F(RoleCheckTest, AVerificationEndsAtAStepThatCannotBeComputed) {
  Alter<radar_t>([](radar_t& radar) { radar.range_m = std::numeric_limits<double>::infinity(); });
  const Verification verification =
      Verify(altered_, {{.role = Role::kRadar, .pid = 1, .host = "", .build = 4, .ours = 5}});
  EXPECT_FALSE(verification.Holds());
  EXPECT_EQ(verification.Trouble(),
            "step 23: the RADAR in the log is not a message of its type, or has a value that is "
            "not finite");
}

TEST_F(RoleCheckTest, AVerificationLeavesOutRolesOfOtherBuilds) {
  const auto other = [](Role role, runtime::BuildId build) {
    return runtime::OtherBuild{.role = role, .pid = 1, .host = "", .build = build, .ours = 5};
  };
  Alter<accel_command_t>([](accel_command_t& command) { command.acceleration_mps2 = 9; });
  const Verification verification =
      Verify(altered_, {other(Role::kAcc, 4), other(Role::kDriver, runtime::kUnknownBuild),
                        other(Role::kArbitrator, 4)});
  EXPECT_TRUE(verification.Holds()) << verification.Trouble();
  EXPECT_THAT(verification.roles, ElementsAre(Role::kWorld, Role::kRadar, Role::kLidar,
                                              Role::kFusion, Role::kFollower));
  ASSERT_THAT(verification.left_out, SizeIs(3));
  EXPECT_EQ(verification.left_out[0].role, Role::kAcc);
  EXPECT_EQ(verification.left_out[0].why, "of another build");
  EXPECT_EQ(verification.left_out[1].role, Role::kDriver);
  EXPECT_EQ(verification.left_out[1].why, "of an unknown build");
}

TEST_F(RoleCheckTest, AVerificationLeavesOutARunInRealTime) {
  log::RunLog run = ReadToTheEnd(log_);
  run.realtime = log::RealtimeFigures{};
  const Verification verification = replay::VerifyRun(log_, run, {});
  EXPECT_THAT(verification.roles, IsEmpty());
  ASSERT_THAT(verification.left_out, SizeIs(kComputing));
  EXPECT_EQ(verification.left_out[0].why, "a run in real time");
}

TEST_F(RoleCheckTest, ASealTellsWhichRolesAreOfOtherBuilds) {
  log::RunLog run = ReadToTheEnd(log_);
  ASSERT_TRUE(run.seal && run.seal->whole);
  EXPECT_THAT(replay::OtherBuildsIn(run), IsEmpty()) << "each role was computed by this program";

  log_seal_t& says = run.seal->says;
  const auto build_of = [&says](std::string_view name) -> std::int64_t& {
    const auto place = std::ranges::find(says.role, name) - says.role.begin();
    return says.build_id.at(static_cast<std::size_t>(place));
  };
  build_of("acc") = 77;
  build_of("driver") = runtime::kUnknownBuild;
  build_of("world") = runtime::BuildIdOf(processes::ProgramOf(Role::kWorld));
  const auto others = replay::OtherBuildsIn(run);
  ASSERT_THAT(others, SizeIs(2));
  EXPECT_EQ(others[0].role, Role::kAcc);
  EXPECT_EQ(others[0].build, 77);
  EXPECT_EQ(others[0].ours, runtime::BuildIdOf(processes::ProgramOf(Role::kAcc)));
  EXPECT_EQ(others[1].role, Role::kDriver);

  run.seal->whole = false;  // an altered seal proves nothing
  EXPECT_THAT(replay::OtherBuildsIn(run), IsEmpty());
  run.seal.reset();
  EXPECT_THAT(replay::OtherBuildsIn(run), IsEmpty());
}

}  // namespace
}  // namespace fogline::test
