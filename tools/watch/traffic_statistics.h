// What goes over an LCM network, run by run, channel by channel, role by role. Not a subscriber and
// not a clock: it is fed with messages and times, and shown by traffic_text and traffic_json.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/graph.h"
#include "services/runtime/clock.h"
#include "services/runtime/refusals.h"
#include "services/runtime/wire.h"
#include "tools/watch/arrivals.h"
#include "tools/watch/step_sequence.h"

namespace fogline {

/// Messages that could not be decoded, by what they seem to be: a type by its fingerprint (then the
/// channel or the size is wrong), or "unknown".
using Undecodable = std::map<std::string, std::int64_t>;

struct ChannelView {
  std::string channel;
  std::string type;  // "" if no message of a known type has come
  ArrivalView arrivals;
  std::optional<StepSequence::Counts> steps;  // of channels with a message in every step
  Undecodable undecodable;

  std::int64_t NumUndecodable() const;
};

/// A role as its last STATUS has it.
struct RoleView {
  status_t status;
  std::optional<double> cpu_percent;  // of one processor; none before two readings
  double age_s = 0;                   // of the last STATUS
  bool silent = false;                // older than kSilent
};

struct RunView {
  std::int64_t run_id = 0;
  std::int64_t step = -1;            // newest on any channel
  std::optional<std::int8_t> phase;  // of run_t, none before the first RUN message
  double pace = 0;
  std::string scenario_hash;
  std::vector<ChannelView> channels;  // in the order of kGraph
  std::vector<RoleView> roles;        // in the order of kRoles, instances as they have come
};

struct TrafficView {
  double interval_s = 0;
  std::vector<RunView> runs;        // in the order of their first message
  std::vector<ChannelView> others;  // messages of no run, by channel's name
  std::int64_t forgotten = 0;       // runs, channels and roles beyond what is kept
};

/// Whether a channel carries no traffic of anybody: what LCM says to itself (its test of the
/// network, and where mpudpm tells its ports), and the beacons of runs.
bool IsHousekeeping(std::string_view channel);

/// Statistics of everything that arrives. What it remembers is bounded, whatever arrives: where
/// there is no room, what has been silent longest is forgotten.
class TrafficStatistics {
 public:
  explicit TrafficStatistics(TimePoint now) : observed_(now) {}

  void Add(std::string_view channel, Bytes bytes, TimePoint now);

  /// What there is to see; ends an interval of observation and begins the next.
  TrafficView Observe(TimePoint now);

  /// How often a message came on a channel whose name was not known, or known no more.
  std::int64_t unknown_names() const { return unknown_names_; }

  /// A role that has not sent STATUS for so long is silent: five heartbeats.
  static constexpr Duration kSilent = milliseconds(1000);
  /// An instance of a role that another one has followed is forgotten when it is silent so long.
  static constexpr Duration kFollowed = milliseconds(10'000);
  static constexpr std::size_t kMaxRuns = 8;
  static constexpr std::size_t kMaxOthers = 64;
  static constexpr std::size_t kMaxRoles = 32;  // of one run, with those that were restarted

 private:
  struct ChannelRecord {
    std::string type;
    Arrivals arrivals;
    std::optional<StepSequence> steps;
    Undecodable undecodable;
    bool any = false;
  };
  struct RoleRecord {
    status_t status;
    TimePoint heard;
    // Reading of processor time that the next one is compared with.
    std::int64_t base_cpu_ms = 0;
    TimePoint base;
    std::optional<double> cpu_percent;
  };
  struct RunRecord {
    std::int64_t run_id = 0;
    TimePoint heard;
    std::optional<std::int8_t> phase;
    double pace = 0;
    std::string scenario_hash;
    std::array<ChannelRecord, kNumChannels> channels;
    std::vector<RoleRecord> roles;
  };

  void AddToRun(RunRecord& run, std::size_t channel, Bytes bytes, TimePoint now);
  void AddRun(RunRecord& run, Bytes bytes);
  void AddStatus(RunRecord& run, Bytes bytes, TimePoint now);
  RunRecord* FindRun(std::int64_t run_id);
  RunRecord& RunOf(std::int64_t run_id);
  ChannelRecord& OtherOf(std::string_view channel);
  static ChannelView ObserveChannel(std::string_view name, ChannelRecord& record, TimePoint now,
                                    Duration interval);
  static void ForgetFollowed(std::vector<RoleRecord>& roles, TimePoint now);
  static std::vector<RoleView> ObserveRoles(RunRecord& run, TimePoint now);

  TimePoint observed_;
  std::vector<RunRecord> runs_;
  std::map<std::string, ChannelRecord, std::less<>> others_;
  std::int64_t forgotten_ = 0;
  std::int64_t unknown_names_ = 0;
};

}  // namespace fogline
