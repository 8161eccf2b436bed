// The other runs of which a log has messages.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fogline::log {

struct RunInLog {
  std::int64_t run_id = 0;
  std::int64_t messages = 0;
};

/// The ids of the runs: "7, 8".
inline std::string IdsOf(const std::vector<RunInLog>& runs) {
  std::string ids;
  for (const RunInLog& run : runs) ids += (ids.empty() ? "" : ", ") + std::to_string(run.run_id);
  return ids;
}

/// Counts messages by run. A file may contain any run ids, so only the first kMost runs are stored.
class OtherRuns {
 public:
  static constexpr std::size_t kMost = 16;

  void Add(std::int64_t run_id) {
    for (RunInLog& run : runs_) {
      if (run.run_id != run_id) continue;
      ++run.messages;
      return;
    }
    if (runs_.size() < kMost) runs_.push_back({.run_id = run_id, .messages = 1});
  }
  /// Removes the run that is being read. @return the number of its messages so far
  std::int64_t Forget(std::int64_t run_id) {
    std::int64_t messages = 0;
    std::erase_if(runs_, [&](const RunInLog& run) {
      if (run.run_id == run_id) messages = run.messages;
      return run.run_id == run_id;
    });
    return messages;
  }
  /// The runs, in the order of their first messages.
  const std::vector<RunInLog>& all() const { return runs_; }

 private:
  std::vector<RunInLog> runs_;
};

}  // namespace fogline::log
