// Reads steps from a log that is still being written, for roles that start again and need their
// inputs.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "services/log/remains.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::recorder {

/// Finds the steps in the recorder's own log, in which the messages of a step are adjacent. The
/// class reads the bytes on request, as they were written, and decodes nothing. There is no index,
/// because an index would grow with the run. A search reads the event numbers in the file instead.
/// In real time messages may be missing, so only the last step can be found.
class History {
 public:
  /// @param front scenario and graph of the log
  /// @param remains the known steps of the log
  History(std::filesystem::path file, const log::LogFront& front, const log::Remains& remains);
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  /// Adds the next step. @param end offset of the first byte after the step
  void Add(std::int64_t end);
  /// The number of known steps.
  std::int64_t steps() const { return steps_; }

  /// Calls `use` with each message of this step, in the order of the log.
  /// @pre the step is known, and its bytes can be read from the file (no buffer of this process
  ///     still holds them)
  /// @throws std::runtime_error if the file cannot be read
  void ForEachMessage(std::int64_t step,
                      const std::function<void(std::string_view channel, runtime::Bytes)>& use);

 private:
  struct Place {
    std::int64_t step = -1;
    std::int64_t begin = 0;  // byte at which the step begins
  };
  /// The byte at which a step begins. @throws std::runtime_error
  std::int64_t Find(std::int64_t step);
  /// Looks at the steps that begin in the next kLook bytes from `from` on, but before `limit`.
  /// @return the last of these steps that is not later than `step`; if all are later, the first of
  ///     them; nullopt if no step begins there
  std::optional<Place> Look(std::int64_t from, std::int64_t limit, std::int64_t step);
  /// Reads bytes of the file, or fewer bytes if the file ends earlier. The bytes are valid until
  /// the next call.
  /// @throws std::runtime_error
  runtime::Bytes Read(std::int64_t from, std::int64_t size);

  std::filesystem::path file_;
  int fd_ = -1;  // opened when first needed
  std::int64_t run_id_;
  bool realtime_;
  std::int64_t step_events_;  // number of events of each step in lockstep
  log::LogHead front_;
  std::int64_t steps_;
  std::int64_t last_;  // byte at which the last step begins
  std::int64_t end_;   // byte at which the last step ends
  // Recently found steps, and the step after each found step, because roles usually request steps
  // in order.
  std::array<Place, runtime::kRingSteps> found_{};
  std::vector<std::uint8_t> chunk_;
};

}  // namespace fogline::recorder
