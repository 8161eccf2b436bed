// A run whose roles, except the recorder, are started by hand on the machines of a laboratory.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/graph.h"
#include "tests/support/network_test.h"

namespace fogline::test {

/// The names of all roles that may be started by hand, in the order of the graph.
inline std::vector<std::string> RolesByHand() {
  std::vector<std::string> names;
  for (const RoleInfo& info : kRoles) {
    if (info.role != Role::kRecorder) names.emplace_back(info.name);
  }
  return names;
}

class ByHandTest : public NetworkTest {
 protected:
  /// Starts a role on one of the machines. The new process replaces the earlier process of the
  /// role.
  void Start(const Lab& lab, const std::string& role) {
    const std::size_t machine = roles_.size() % lab.machines().size();
    roles_[role] = std::make_unique<Background>(
        lab[machine].On({Program("fogline-" + role), "--lcm-url", kUrl}));
  }
  void Kill(const std::string& role) {
    roles_.at(role)->Signal(SIGKILL);
    roles_.at(role)->Wait();
  }
  /// The command line of a run that waits for all roles.
  std::vector<std::string> RunOfAll(const Lab& lab, std::vector<std::string> more = {}) {
    for (const std::string& role : RolesByHand()) more.insert(more.end(), {"--external", role});
    more.insert(more.end(), {"--lcm-url", kUrl});
    return lab[0].On(Run(more));
  }
  /// Expects that every role leaves by itself at the end of the run.
  void ExpectAllLeave() {
    for (const auto& [role, process] : roles_) {
      EXPECT_EQ(process->Wait(), 0) << role << ": " << process->Err();
    }
  }
  /// Kills these roles one after another in the middle of a run, and starts each again. The result
  /// must be that of an undisturbed run.
  void ExpectEachMayBeStartedAgain(const std::vector<std::string>& killed,
                                   const std::string& pace) {
    const Lab lab(3);
    Background run(RunOfAll(lab, {"--pace", pace}));
    for (const std::string& role : RolesByHand()) Start(lab, role);
    std::uintmax_t bytes = 20'000;  // a dozen steps
    for (const std::string& role : killed) {
      SCOPED_TRACE(role);
      ASSERT_TRUE(GrowsTo(bytes, Log())) << run.Err();
      Kill(role);
      const std::uintmax_t before = std::filesystem::file_size(Log());
      Start(lab, role);
      bytes = before + 20'000;  // if the log has this size, the run has gone on
    }
    const auto result = ResultOf(run);
    EXPECT_EQ(result["digest"], Undisturbed());
    EXPECT_EQ(result["restarts"].size(), killed.size()) << result["restarts"];
    ExpectAllLeave();
  }

 private:
  std::map<std::string, std::unique_ptr<Background>> roles_;
};

}  // namespace fogline::test
