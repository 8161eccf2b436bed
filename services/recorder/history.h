// The steps of a log that is still being written: what a recorder that was killed has left in it,
// and where each step lies, so that roles that start again can have their inputs from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "services/recorder/event_log.h"
#include "services/runtime/step_ring.h"

namespace fogline {

/// Where the steps lie in the recorder's own log: step by step, the messages of a step together.
/// The bytes are read when they are asked for, as they were written; nothing is decoded.
class History {
 public:
  /// @param begin byte at which step 0 begins
  explicit History(std::filesystem::path file, std::int64_t begin = 0);
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  /// Makes room, so that no step of a run of usual length allocates.
  void Reserve(std::int64_t steps) { ends_.reserve(static_cast<std::size_t>(steps) + 1); }
  /// The next step ends before this byte.
  void Add(std::int64_t end) { ends_.push_back(end); }
  /// Steps that are known.
  std::int64_t steps() const { return static_cast<std::int64_t>(ends_.size()) - 1; }
  /// Bytes of the file up to the end of the last step.
  std::int64_t bytes() const { return ends_.back(); }

  /// Calls `use` with a channel's message of each of these steps, in order.
  /// @pre the steps are known, and the operating system has their bytes
  /// @throws std::runtime_error if the file cannot be read
  void ForEach(std::string_view channel, StepRange steps, const std::function<void(Bytes)>& use);

 private:
  std::filesystem::path file_;
  int fd_ = -1;  // opened when first needed
  std::vector<std::int64_t>
      ends_;  // byte at which each step ends; before them, where step 0 begins
  std::vector<std::uint8_t> chunk_;
};

/// What is in the log of a recorder that was killed.
struct Remains {
  LogHead head;                    // the scenario and the complete steps
  std::int64_t begin = 0;          // byte at which step 0 begins
  std::vector<std::int64_t> ends;  // byte at which each complete step ends
  bool final = false;              // the last of them is the last one of the run
};

/// Looks through a log that a recorder was writing. What follows the last complete step (a torn
/// event, an incomplete step) does not count.
/// @return nothing if there is not even the whole scenario in it: it may be begun anew
/// @throws InputError if it is no event log, or that of another run or scenario
std::optional<Remains> ReadRemains(const std::filesystem::path& file, std::int64_t run_id,
                                   const std::string& scenario_hash);

}  // namespace fogline
