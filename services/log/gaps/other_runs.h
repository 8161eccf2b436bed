// The other runs of which a log has messages.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fogline::log {

struct RunInLog {
  std::int64_t run_id = 0;
  std::int64_t messages = 0;
  std::optional<std::int64_t> first_step;  // the smallest step of these messages, if one has a step
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

  /// @param step of the message; nullopt if the message is of no step
  void Add(std::int64_t run_id, std::optional<std::int64_t> step = std::nullopt) {
    for (RunInLog& run : runs_) {
      if (run.run_id != run_id) continue;
      ++run.messages;
      if (step) run.first_step = std::min(*step, run.first_step.value_or(*step));
      return;
    }
    if (runs_.size() == kMost) return;
    runs_.push_back({.run_id = run_id, .messages = 1, .first_step = step});
  }
  /// Removes the run that is being read. @return its messages so far
  RunInLog Forget(std::int64_t run_id) {
    RunInLog forgotten{.run_id = run_id};
    std::erase_if(runs_, [&](const RunInLog& run) {
      if (run.run_id == run_id) forgotten = run;
      return run.run_id == run_id;
    });
    return forgotten;
  }
  /// The runs, in the order of their first messages.
  const std::vector<RunInLog>& all() const { return runs_; }

 private:
  std::vector<RunInLog> runs_;
};

}  // namespace fogline::log
