// Minutes of real time on a machine whose cores are all in use.
#include <gtest/gtest.h>

#include "tests/integration/realtime/realtime_under_load.h"

namespace fogline::test {
namespace {

TEST(RealtimeUnderLoadTest, MissesNothingInTenMinutesAt10Hz) {
  ExpectRunUnderLoadMissesNothing(10, 600);
}

TEST(RealtimeUnderLoadTest, MissesNothingInFiveMinutesAt100Hz) {
  ExpectRunUnderLoadMissesNothing(100, 300);
}

}  // namespace
}  // namespace fogline::test
