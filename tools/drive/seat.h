// A seat: reads a device and publishes DRIVER_INPUT on the network of a run.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "services/runtime/transport/traffic_options.h"
#include "tools/drive/pedal_source.h"

namespace fogline::drive {

/// Makes the messages of a seat. A message is due at each change of the state, and at least every
/// 40 ms. At most 200 messages a second are due. The interval and the rate are each a fifth below
/// their limits in services/runtime/wire/driver_input.h.
class InputMaker {
 public:
  static constexpr Duration kEvery = milliseconds(40);
  static constexpr Duration kLeast = milliseconds(5);

  InputMaker(std::int64_t run_id, std::int64_t instance, std::int8_t kind, const std::string& name);

  /// Stores the header of the newest TRUTH. Headers of other runs are ignored.
  void SawTruth(const header_t& header);
  /// Whether this state must be sent now.
  bool Due(const PedalState& state, TimePoint now) const;
  /// Makes the message of this state. The state then counts as sent. The message is valid until the
  /// next call.
  const driver_input_t& Make(const PedalState& state, TimePoint now);

 private:
  driver_input_t out_{};
  PedalState sent_;
  TimePoint sent_at_{};
};

/// The beginning of a text: at most `most` bytes, without an incomplete character at its end.
std::string FirstBytes(const std::string& text, std::size_t most);

/// A seat: a thread with its own bus. It publishes the inputs of the device. It also prints texts
/// for the person, such as "take over, please" and "the automation drives".
class Seat {
 public:
  Seat(const std::string& url, std::int64_t run_id, const runtime::TrafficOptions& traffic,
       std::unique_ptr<PedalSource> source);
  /// Publishes that no person is present, and ends the thread.
  ~Seat();
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;

 private:
  void Run(const std::string& url, std::int64_t run_id, const runtime::TrafficOptions& traffic);
  void Tell(std::int8_t mode);

  std::unique_ptr<PedalSource> source_;
  std::string_view told_;  // the text that the person saw last
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace fogline::drive
