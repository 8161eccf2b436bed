// Decodes the messages of a step into its Sample. In a log of a run in real time, messages may be
// missing. The values of missing messages are NaN.
#pragma once

#include "services/metrics/sample.h"
#include "services/runtime/wire/wire.h"

namespace fogline::metrics {

class SampleDecoder {
 public:
  /// @param messages the encoded messages of a step, by index in kChannels
  /// @return the sample, valid until the next call; nullptr if a message cannot be decoded
  template <class Messages>
  const Sample* Decode(const Messages& messages) {
    return DecodeWith([&messages]<class M>(M& message) {
      return fogline::runtime::Decode(messages[IndexOf<M>()], message);
    });
  }

  /// Decodes a step in which messages may be missing.
  /// @return as Decode(); also nullptr if TRUTH is missing
  template <class Messages>
  const Sample* DecodeWithHoles(const Messages& messages) {
    if (messages[IndexOf<truth_t>()].empty()) return nullptr;
    return DecodeWith([&messages]<class M>(M& message) {
      const auto& bytes = messages[IndexOf<M>()];
      if (bytes.empty()) message = Missing<M>();
      return bytes.empty() || fogline::runtime::Decode(bytes, message);
    });
  }

  /// Messages of the last decoded step.
  const truth_t& truth() const { return truth_; }
  const track_t& track() const { return track_; }
  const driver_command_t& driver() const { return driver_; }
  const arbitration_t& host() const { return host_; }
  const follower_command_t& follower() const { return follower_; }

 private:
  /// A message in which all real numbers are NaN, and all other fields 0 or empty.
  template <class M>
  static M Missing() {
    M message{};
    VisitFields(message, []<class V>(std::string_view, const V& value) {
      if constexpr (std::is_same_v<V, double>) {
        const_cast<double&>(value) = std::numeric_limits<double>::quiet_NaN();
      }
    });
    return message;
  }

  template <class Take>
  const Sample* DecodeWith(const Take& take) {
    if (!(take(truth_) && take(radar_) && take(lidar_) && take(track_) && take(acc_) &&
          take(driver_) && take(host_) && take(follower_))) {
      return nullptr;
    }
    sample_ = MakeSample(truth_, radar_, lidar_, track_, acc_, driver_, host_, follower_);
    return &sample_;
  }

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

}  // namespace fogline::metrics
