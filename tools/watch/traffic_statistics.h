// Statistics of the traffic on an LCM network, by run, channel and role. The caller passes messages
// and times as arguments. No code in this file subscribes to a channel or reads a clock.
// traffic_text and traffic_json show the result.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/clock.h"
#include "services/graph.h"
#include "services/runtime/wire/refusals.h"
#include "services/runtime/wire/wire.h"
#include "tools/watch/arrivals.h"
#include "tools/watch/step_sequence.h"

namespace fogline::watch {

/// The number of messages that could not be decoded, by the type that their fingerprint names, or
/// by "unknown". If the fingerprint names a type, the message came on a channel of another type, or
/// its size is wrong.
using Undecodable = std::map<std::string, std::int64_t>;

struct ChannelView {
  std::string channel;
  std::string type;  // "" if no message of a known type has arrived
  ArrivalView arrivals;
  std::optional<StepSequence::Counts> steps;  // only for channels with a message in every step
  Undecodable undecodable;
  std::vector<std::uint8_t> newest;  // the last message; in a run, the last one that was decoded

  std::int64_t NumUndecodable() const;
};

/// A role according to its last STATUS.
struct RoleView {
  status_t status{};
  std::optional<double> cpu_percent;  // use of one processor; nullopt before the second reading
  double age_s = 0;                   // age of the last STATUS
  bool silent = false;                // whether the last STATUS is older than kSilent
};

struct RunView {
  std::int64_t run_id = 0;
  std::int64_t step = -1;            // newest step on all channels
  std::optional<std::int8_t> phase;  // phase of the last RUN; nullopt before the first RUN
  double pace = 0;
  bool realtime = false;
  std::string scenario_hash;
  std::vector<ChannelView> channels;  // in the order of kGraph
  std::vector<RoleView> roles;        // in the order of kRoles, instances in the order of their
                                      // arrival
};

struct TrafficView {
  double interval_s = 0;
  std::vector<RunView> runs;        // in the order of their first message
  std::vector<ChannelView> others;  // messages that belong to no run, by the name of their channel
  std::int64_t forgotten = 0;       // number of runs, channels and roles that were dropped for lack
                                    // of room
};

/// Whether the messages of a channel only organise or test the network. The tools do not show or
/// record such messages as traffic. These channels are LCM's own (the self-test of the network, and
/// the announcements of ports by mpudpm), the channels of beacons and of waiting roles, and the
/// channels of `fogline doctor`.
bool IsHousekeeping(std::string_view channel);

/// Statistics of all messages that arrive. The memory is bounded for any input: if there is no
/// room, the entry whose last message is oldest is forgotten.
class TrafficStatistics {
 public:
  explicit TrafficStatistics(TimePoint now) : observed_(now) {}

  void Add(std::string_view channel, runtime::Bytes bytes, TimePoint now);

  /// Returns the current statistics. Ends an interval of observation and begins the next interval.
  TrafficView Observe(TimePoint now);

  /// Number of messages on channels whose names were unknown or forgotten.
  std::int64_t unknown_names() const { return unknown_names_; }

  /// A role that has sent no STATUS for this long is silent. In this time a role sends five
  /// heartbeats.
  static constexpr Duration kSilent = milliseconds(1000);
  /// If a newer instance has replaced an instance of a role, the old instance is forgotten after
  /// this time without a STATUS.
  static constexpr Duration kFollowed = milliseconds(10'000);
  static constexpr std::size_t kMaxRuns = 8;
  static constexpr std::size_t kMaxOthers = 64;
  static constexpr std::size_t kMaxRoles = 32;  // limit for one run, including restarted roles

 private:
  struct ChannelRecord {
    std::string type;
    Arrivals arrivals;
    std::optional<StepSequence> steps;
    Undecodable undecodable;
    std::vector<std::uint8_t> newest;
    bool any = false;
  };
  struct RoleRecord {
    status_t status;
    TimePoint heard;
    // The last reading of processor time, for comparison with the next reading.
    std::int64_t base_cpu_ms = 0;
    TimePoint base;
    std::optional<double> cpu_percent;
  };
  struct RunRecord {
    std::int64_t run_id = 0;
    TimePoint heard;
    std::optional<std::int8_t> phase;
    double pace = 0;
    bool realtime = false;
    std::string scenario_hash;
    std::array<ChannelRecord, kNumChannels> channels;
    std::vector<RoleRecord> roles;
  };

  void AddToRun(RunRecord& run, std::size_t channel, runtime::Bytes bytes, TimePoint now);
  void AddRun(RunRecord& run, runtime::Bytes bytes);
  void AddStatus(RunRecord& run, runtime::Bytes bytes, TimePoint now);
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

}  // namespace fogline::watch
