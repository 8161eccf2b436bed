// Each role is killed in one run and stopped in another, in two scenarios that run in real time.
#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include "tests/integration/realtime/realtime_fault.h"

namespace fogline::test {
namespace {

std::vector<Fault> EveryFault() {
  std::vector<Fault> faults;
  for (const char* scenario : {"paper", "dense_fog"}) {
    for (const RoleInfo& role : kRoles) {
      for (const int signal : {SIGKILL, SIGSTOP}) {
        faults.push_back({scenario, std::string(role.name), signal});
      }
    }
  }
  return faults;
}

TEST_P(FaultInRealtimeTest, LeavesNoCarUndecided) { ExpectFaultLeavesNoCarUndecided(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Every, FaultInRealtimeTest, testing::ValuesIn(EveryFault()), NameOfFault);

}  // namespace
}  // namespace fogline::test
