// A minute of hostile traffic at the rate that Fogline promises to withstand.
#include <gtest/gtest.h>

#include "tests/integration/network/hostile_traffic.h"

namespace fogline::test {
namespace {

constexpr Hostility kAMinute{.seconds = 60,
                             .rate_hz = 20'000,
                             .least_sent = 0.9 * 20'000 * 60,
                             .least_of_a_kind = 500,
                             .alone = true};

TEST_F(HostileTrafficTest, ChangesNoResultAndIsRefusedByKind) {
  ExpectNoResultChangesAndEachKindIsRefused(kAMinute);
}

TEST_P(FloodTest, ChangesNoResult) { ExpectFloodChangesNoResult(GetParam(), kAMinute); }

INSTANTIATE_TEST_SUITE_P(Of, FloodTest, kFloods, NameOfFlood);

}  // namespace
}  // namespace fogline::test
