// A few seconds of hostile traffic, at a rate that even a busy machine can send and process. The
// tests demand only a small number of sent datagrams.
#include <gtest/gtest.h>

#include "tests/integration/network/hostile_traffic.h"

namespace fogline::test {
namespace {

Hostility For(double seconds) {
  return {.seconds = seconds, .rate_hz = 4'000, .least_sent = 1'000, .least_of_a_kind = 50};
}

TEST_F(HostileTrafficTest, ChangesNoResultAndIsRefusedByKind) {
  ExpectNoResultChangesAndEachKindIsRefused(For(4));
}

TEST_P(FloodTest, ChangesNoResult) { ExpectFloodChangesNoResult(GetParam(), For(1.5)); }

INSTANTIATE_TEST_SUITE_P(Of, FloodTest, kFloods, NameOfFlood);

}  // namespace
}  // namespace fogline::test
