// The messages that the arbitrator in real time reads. A test can change them.
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

#include "services/arbitrator/failsafe_arbitrator.h"

namespace fogline::test {

class FailsafeInputsTest : public testing::Test {
 protected:
  ego_t ego_{};
  radar_t radar_{};
  lidar_t lidar_{};
  track_t track_{};
  accel_command_t automation_{};
  driver_command_t driver_{};
  arbitrator::ArbitratorInputs inputs_;
  std::int64_t step_ = 0;
};

}  // namespace fogline::test
