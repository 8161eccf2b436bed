// Processes that send on a run's network but are not part of the run (foreign peers). They are
// roles of another run, processes that are left over from an earlier run, or processes that claim a
// role which another process of this run has. Their messages are refused. This class only records
// which processes they are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fogline/status_t.hpp"

namespace fogline::runtime {

struct ForeignPeer {
  std::string role;
  std::int64_t pid;
  std::string host;
  std::int64_t run_id;
};

/// Returns a text such as "fusion (pid 4711 on lab2) of run 123".
std::string Describe(const ForeignPeer& peer);

/// The foreign processes that sent the most STATUS messages. At most kMaxWatched processes are
/// remembered: a further process replaces the process with the fewest STATUS messages. So a flood
/// of invented names does not fill the memory, and does not hide a process that continues to send.
class ForeignPeers {
 public:
  /// The largest number of processes that are reported.
  static constexpr std::size_t kMax = 32;
  /// The largest number of processes that are remembered. A role sends a STATUS at least every 0.2
  /// s. In this time a flood of 5,000 invented names a second adds 1,000 names, so it does not
  /// displace a genuine process.
  static constexpr std::size_t kMaxWatched = 1024;

  /// Counts a STATUS of a foreign process. A STATUS whose role does not exist is ignored. Host
  /// names are shortened and made safe to print.
  void Hear(const status_t& status);

  /// The processes that sent the most STATUS messages, at most kMax, in the order of their first
  /// STATUS.
  std::vector<ForeignPeer> known() const;
  /// A line "ignored: ..." for each process of known(), and one more line if there were more than
  /// kMax processes; "" if there were no foreign processes.
  std::string Text() const;

 private:
  struct Watched {
    ForeignPeer peer;
    std::int64_t heard;
  };
  std::vector<Watched> watched_;  // in the order of their first STATUS
  bool forgotten_ = false;
};

}  // namespace fogline::runtime
