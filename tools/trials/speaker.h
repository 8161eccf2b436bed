// Sends the facts of a trial to the recorder during the run. A speaker has a thread of its own,
// because the runner's thread is busy with the run.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "fogline/trial_t.hpp"
#include "services/runtime/transport/traffic_options.h"

namespace fogline::trials {

class Speaker {
 public:
  /// Sends the fact BEGIN when the first TRUTH of the run comes. Before this TRUTH the recorder may
  /// not listen yet, so earlier facts are kept until then. BEGIN has the time at which this TRUTH
  /// came. If a marker or the end comes first, BEGIN has the time at which the speaker was made.
  /// @param base a fact with the values that all facts of the trial share
  /// @throws std::runtime_error as RequireReadable(), before the first fact is sent
  Speaker(const std::string& url, std::int64_t run_id, const runtime::TrafficOptions& traffic,
          trial_t base);
  /// Ends the thread.
  ~Speaker();
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  /// Sends a marker of the experimenter, cut to the length that a TRIAL can have. May be called
  /// from any thread.
  void Mark(const std::string& text);

  /// Ends the thread.
  /// @return every fact so far, at least BEGIN; the log may lack some of these facts, because a
  ///     network can lose messages
  std::vector<trial_t> End();

 private:
  /// Adds the fact BEGIN if it is missing. @pre mutex_ is locked
  void Begin(std::int64_t unix_us);
  void Work(const std::string& url, const runtime::TrafficOptions& traffic);

  trial_t base_;
  std::mutex mutex_;
  std::vector<trial_t> facts_;  // all facts so far, by sequence number
  std::size_t sent_ = 0;
  std::int64_t step_ = -1;
  std::int64_t utime_ = 0;
  std::int64_t made_us_;  // when the speaker was made, in microseconds since 1970 (UTC)
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

/// Microseconds since 1970 (UTC).
std::int64_t UnixMicros();

}  // namespace fogline::trials
