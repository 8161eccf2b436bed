// A role in a run, with its algorithm. The example is the driver: TRUTH in, DRIVER_COMMAND out.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string_view>
#include <vector>

#include "services/driver/driver.h"
#include "services/runtime/process/step_node.h"
#include "tests/unit/services/runtime/script.h"

namespace fogline::test {

class DriverInRun : public testing::Test {
 protected:
  truth_t Truth(std::int64_t step) {
    auto truth = Script::Of<truth_t>(step);
    truth.host_gap_m = 40;
    truth.host_speed_mps = 20 + 0.01 * static_cast<double>(step);
    return truth;
  }
  /// The encoded TRUTH of a step, for tests that change its bytes.
  std::vector<std::uint8_t> Encoded(const truth_t& truth) {
    std::vector<std::uint8_t> bytes;
    runtime::Encode(truth, bytes);
    return bytes;
  }
  void SayBytes(std::string_view channel, runtime::Bytes bytes) {
    script_.bus().Publish(channel, bytes);
    script_.bus().Drain();
  }
  /// The node's next STATUS; half a second passes for the node.
  const status_t& Status() {
    later_ += milliseconds(500);
    script_.Poll(node_, Clock::now() + later_);
    return status_.back();
  }
  /// Publishes three invalid messages of a step.
  void SayUnsound(std::int64_t step) {
    std::vector<std::uint8_t> other_type = Encoded(Truth(step));
    other_type[0] ^= 1;
    SayBytes("TRUTH", other_type);
    std::vector<std::uint8_t> longer = Encoded(Truth(step));
    longer.push_back(0);
    SayBytes("TRUTH", longer);
    truth_t nan = Truth(step);
    nan.host_gap_m = std::numeric_limits<double>::quiet_NaN();
    SayBytes("TRUTH", Encoded(nan));
  }

  /// Answers every RESEND of TRUTH with all requested steps, as if no message were lost.
  void AnswerRequests() {
    while (served_ < requests_.size()) {
      const resend_t request = requests_[served_++];
      if (request.channel != "TRUTH") continue;
      for (std::int64_t k = 0; k < request.count; ++k) {
        script_.Say(Truth(request.header.step + k));
      }
      script_.Poll(node_);
    }
  }

  Script script_;
  std::vector<resend_t>& requests_ = script_.Listen<resend_t>();
  std::vector<driver_command_t>& commands_ = script_.Listen<driver_command_t>();
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  runtime::StepNode<driver::Driver> node_{script_.bus(), Script::kRunId};
  runtime::OwnStatus& own_ = node_.node().parts().own;
  std::size_t served_ = 0;
  Duration later_{};
};

}  // namespace fogline::test
