// A few seconds of real time on a machine whose cores are all in use.
#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "tests/integration/realtime/realtime_under_load.h"

namespace fogline::test {
namespace {

constexpr double kSeconds = 5;

struct Rhythm {
  int rate_hz;
};

void PrintTo(const Rhythm& rhythm, std::ostream* out) { *out << rhythm.rate_hz << " Hz"; }

class RealtimeUnderLoadTest : public testing::TestWithParam<Rhythm> {};

TEST_P(RealtimeUnderLoadTest, MissesNothingAndGrowsNowhere) {
  ExpectRunUnderLoadMissesNothing(GetParam().rate_hz, kSeconds);
}

INSTANTIATE_TEST_SUITE_P(At, RealtimeUnderLoadTest, testing::Values(Rhythm{10}, Rhythm{100}),
                         [](const auto& rhythm) {
                           return std::to_string(rhythm.param.rate_hz) + "Hz";
                         });

}  // namespace
}  // namespace fogline::test
