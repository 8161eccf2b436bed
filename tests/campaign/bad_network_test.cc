// The whole run of the paper's scenario on bad networks.
#include <gtest/gtest.h>

#include "tests/integration/network/bad_network.h"

namespace fogline::test {
namespace {

constexpr int kWholeRun = 500;

TEST_F(BadNetworkTest, LossDuplicatesOvertakingAndDelayChangeNoResult) {
  ExpectLossDuplicatesOvertakingAndDelayChangeNoResult(kWholeRun);
}

TEST_F(BadNetworkTest, DamagedMessagesChangeNoResultOfASignedRun) {
  ExpectDamagedMessagesChangeNoResultOfASignedRun(kWholeRun);
}

}  // namespace
}  // namespace fogline::test
