// Short runs on a bad network, and refused values of --faults. network_test.cc has networks that
// the kernel simulates.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/integration/network/bad_network.h"

namespace fogline::test {
namespace {

TEST_F(BadNetworkTest, LossDuplicatesOvertakingAndDelayChangeNoResult) {
  ExpectLossDuplicatesOvertakingAndDelayChangeNoResult(40);
}

TEST_F(BadNetworkTest, DamagedMessagesChangeNoResultOfASignedRun) {
  ExpectDamagedMessagesChangeNoResultOfASignedRun(250);
}

TEST_F(BadNetworkTest, IsRefusedWhereItCannotBe) {
  const auto error = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {Program("fogline"), "run", "scenario/paper.json"});
    const Outcome outcome = RunCommand(more);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(error({"--faults", "flip=0.1"}).find("truncate and flip need --key"),
            std::string::npos);
  EXPECT_NE(error({"--faults", "los=0.1"}).find("\"los\" is no kind of fault"), std::string::npos);
  EXPECT_NE(error({"--faults", "loss=0.1", "--transport", "direct"}).find("has no messages"),
            std::string::npos);
  const Outcome service = RunCommand({Program("fogline-acc"), "--faults", "loss=2"});
  EXPECT_EQ(service.code, 2);
  EXPECT_NE(service.err.find("fogline-acc: error: --faults: loss=2 is outside [0, 1)"),
            std::string::npos)
      << service.err;
}

}  // namespace
}  // namespace fogline::test
