#include "tools/hosts/run_plan.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/command.h"
#include "tests/support/input_errors.h"

namespace fogline::test {
namespace {

using hosts::HostPlan;
using hosts::MakePlan;
using hosts::PlanWords;
using hosts::RunPlan;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string PlanRefusal(const PlanWords& words) {
  return ErrorOf([&words] { MakePlan(words); });
}

/// The only machine of a plan with one --on.
HostPlan HostOf(const std::string& host) {
  return MakePlan({.on = {"fusion=" + host}}).hosts.at(0);
}

TEST(RunPlanTest, WithoutOnAndLabNoRoleRunsElsewhere) { EXPECT_TRUE(MakePlan({}).empty()); }

TEST(RunPlanTest, OneMachineMayHaveSeveralRoles) {
  const RunPlan plan = MakePlan({.on = {"fusion=lab2", "acc=anna@lab3", "radar=lab2"}});
  EXPECT_THAT(plan.hosts,
              ElementsAre(HostPlan{"lab2", "lab2", ""}, HostPlan{"anna@lab3", "anna@lab3", ""}));
  EXPECT_EQ(plan.places,
            (std::map<Role, std::size_t>{{Role::kFusion, 0}, {Role::kAcc, 1}, {Role::kRadar, 0}}));
}

TEST(RunPlanTest, AMachineMayNameTheFolderOfItsPrograms) {
  EXPECT_EQ(HostOf("anna@lab2:/opt/fogline/bin"),
            (HostPlan{"anna@lab2", "anna@lab2", "/opt/fogline/bin"}));
  EXPECT_EQ(HostOf("lab2:~/fogline/build/bin").programs, "~/fogline/build/bin");
  EXPECT_EQ(HostOf("ssh://anna@lab2:2222"),
            (HostPlan{"ssh://anna@lab2:2222", "ssh://anna@lab2:2222", ""}));
  EXPECT_EQ(HostOf("fd00::2"), (HostPlan{"fd00::2", "fd00::2", ""}));
}

TEST(RunPlanTest, WrongPlacesAreNamed) {
  EXPECT_EQ(PlanRefusal({.on = {"fusion"}}),
            "error: --on fusion: must be ROLE=HOST, such as fusion=user@lab2");
  EXPECT_THAT(PlanRefusal({.on = {"fusoin=lab2"}}),
              AllOf(StartsWith("error: --on fusoin=lab2: \"fusoin\" is no role; did you mean "
                               "\"fusion\"?; roles are \"world\", \"radar\", "),
                    EndsWith(", \"follower\""), Not(HasSubstr("recorder"))));
  EXPECT_EQ(PlanRefusal({.on = {"recorder=lab2"}}),
            "error: --on recorder=lab2: the recorder runs on the machine of the run, whose result "
            "is read from its log");
  EXPECT_EQ(PlanRefusal({.on = {"fusion="}}),
            "error: --on fusion=: the name of the machine is missing");
  EXPECT_EQ(PlanRefusal({.on = {"fusion=-oProxyCommand=x"}}),
            "error: --on fusion=-oProxyCommand=x: \"-oProxyCommand=x\" is no machine, because ssh "
            "would read it as an option");
  EXPECT_EQ(PlanRefusal({.on = {"fusion=lab2:rel/path"}}),
            "error: --on fusion=lab2:rel/path: \"lab2:rel/path\" is no machine, because it has a "
            "\"/\"; a folder begins with / or ~/");
  EXPECT_EQ(PlanRefusal({.on = {"fusion=lab2:/a", "acc=lab2:/b"}}),
            "error: --on acc=lab2:/b: the programs of \"lab2\" are in \"/a\" already");
  EXPECT_EQ(PlanRefusal({.on = {"fusion=lab2", "fusion=lab3"}}),
            "error: --on fusion=lab3: another --on has a machine for the fusion");
  EXPECT_EQ(PlanRefusal({.on = {"fusion=lab2"}, .relay_at = "10.0.0.1:99999"}),
            "error: --relay-at: \"99999\" is no port (0 to 65535)");
  EXPECT_EQ(PlanRefusal({.on = {"fusion=lab2"}, .relay_at = ":7700"}),
            "error: --relay-at: the address before the port is missing");
  // RFC 5737: no machine has an address of 203.0.113.0/24.
  EXPECT_EQ(PlanRefusal({.on = {"fusion=lab2"}, .relay_at = "203.0.113.7"}),
            "error: --relay-at: 203.0.113.7 is no address of this machine (`ip address` lists "
            "them)");
  EXPECT_EQ(
      PlanRefusal({.on = {"fusion=lab2"}, .relay_at = "0.0.0.0:7700"}),
      "error: --relay-at: 0.0.0.0 is each machine itself; name the address at which the other "
      "machines reach this one");
  EXPECT_EQ(PlanRefusal({.relay = true}),
            "error: --relay: no role runs on another machine; see --on");
  EXPECT_EQ(PlanRefusal({.ssh = "ssh -4"}),
            "error: --ssh ssh -4: no role runs on another machine; see --on");
}

TEST(RunPlanTest, TheCommandLineComesBeforeTheLaboratorysFile) {
  const ScratchFolder folder;
  const std::string file = folder.File("lab.json");
  std::ofstream(file) << R"({"version": 1, "key": "lab.key", "ssh": "ssh -p 2222", "hosts": [
      {"name": "rig", "ssh": "anna@10.0.0.2", "programs": "/opt/bin", "roles": ["fusion", "acc"]},
      {"name": "spare"}]})";
  const RunPlan plan = MakePlan({.on = {"acc=spare", "radar=lab9"}, .lab = file});
  EXPECT_THAT(plan.hosts, ElementsAre(HostPlan{"lab9", "lab9", ""},
                                      HostPlan{"rig", "anna@10.0.0.2", "/opt/bin"},
                                      HostPlan{"spare", "spare", ""}));
  EXPECT_EQ(plan.places,
            (std::map<Role, std::size_t>{{Role::kRadar, 0}, {Role::kFusion, 1}, {Role::kAcc, 2}}));
  EXPECT_EQ(plan.key_file, folder.File("lab.key"));
  EXPECT_EQ(plan.ssh, "ssh -p 2222");
  EXPECT_EQ(MakePlan({.lab = file, .ssh = "ssh -4"}).ssh, "ssh -4");
  EXPECT_THAT(plan.words, ElementsAre("--lab", file, "--on", "acc=spare", "--on", "radar=lab9"));
}

TEST(RunPlanTest, TheEnvironmentMayReplaceSsh) {
  setenv("FOGLINE_SSH", "ssh -F lab.ssh", 1);
  const std::string from_environment = MakePlan({.on = {"acc=lab2"}}).ssh;
  const std::string from_option = MakePlan({.on = {"acc=lab2"}, .ssh = "ssh -4"}).ssh;
  unsetenv("FOGLINE_SSH");
  EXPECT_EQ(from_environment, "ssh -F lab.ssh");
  EXPECT_EQ(from_option, "ssh -4");
  EXPECT_EQ(MakePlan({.on = {"acc=lab2"}}).ssh, "ssh");
}

}  // namespace
}  // namespace fogline::test
