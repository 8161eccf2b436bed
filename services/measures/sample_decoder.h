// From the encoded messages of a step to its Sample.
#pragma once

#include "services/measures/sample.h"
#include "services/runtime/wire.h"

namespace fogline {

class SampleDecoder {
 public:
  /// @param messages the bytes of a step by place in kChannels
  /// @return the sample, valid until the next call; nullptr if a message does not decode
  template <class Messages>
  const Sample* Decode(const Messages& messages) {
    const auto take = [&messages]<class M>(M& message) {
      return fogline::Decode(messages[IndexOf<M>()], message);
    };
    if (!(take(truth_) && take(radar_) && take(lidar_) && take(track_) && take(acc_) &&
          take(driver_) && take(host_) && take(follower_))) {
      return nullptr;
    }
    sample_ = MakeSample(truth_, radar_, lidar_, track_, acc_, driver_, host_, follower_);
    return &sample_;
  }

 private:
  truth_t truth_{};
  radar_t radar_{};
  lidar_t lidar_{};
  track_t track_{};
  accel_command_t acc_{};
  driver_command_t driver_{};
  arbitration_t host_{};
  follower_command_t follower_{};
  Sample sample_;
};

}  // namespace fogline
