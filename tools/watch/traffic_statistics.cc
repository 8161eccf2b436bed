#include "tools/watch/traffic_statistics.h"

#include <algorithm>
#include <tuple>

#include "services/runtime/discovery/announcements.h"
#include "services/runtime/discovery/waiting_roles.h"
#include "services/runtime/wire/message_signer.h"

namespace fogline::watch {
namespace {

struct KnownType {
  std::int64_t fingerprint;
  const char* name;
  bool (*decodes)(runtime::Bytes);
};

template <class M>
bool Decodes(runtime::Bytes bytes) {
  M message{};
  return runtime::Decode(bytes, message);
}

/// The type of every channel, in the order of kGraph.
const auto& KnownTypes() {
  static const auto types = std::apply(
      []<class... M>(const Channel<M>&...) {
        return std::array{KnownType{M::getHash(), M::getTypeName(), &Decodes<M>}...};
      },
      kGraph);
  return types;
}

/// Name of the message's type, by the fingerprint; "" if Fogline has no type with this fingerprint.
std::string_view TypeNameOf(runtime::Bytes bytes) {
  if (bytes.size() < runtime::kRunIdOffset) return "";
  for (const KnownType& type : KnownTypes()) {
    if (type.fingerprint == runtime::ReadInt64(bytes, 0)) return type.name;
  }
  return "";
}

void CountUndecodable(runtime::Bytes bytes, Undecodable& undecodable) {
  const std::string_view type = TypeNameOf(bytes);
  ++undecodable[type.empty() ? "unknown" : std::string(type)];
}

}  // namespace

std::int64_t ChannelView::NumUndecodable() const {
  std::int64_t sum = 0;
  for (const auto& entry : undecodable) sum += entry.second;
  return sum;
}

bool IsHousekeeping(std::string_view channel) {
  return channel == "LCM_SELF_TEST" || channel.starts_with("#!mpudpm") ||
         channel == runtime::kBeaconChannel || channel == runtime::kWaitingChannel ||
         channel == "FOGLINE_PING" || channel == "FOGLINE_PONG" || channel == "FOGLINE_DOCTOR";
}

void TrafficStatistics::Add(std::string_view channel, runtime::Bytes bytes, TimePoint now) {
  if (runtime::LooksSigned(bytes))
    bytes = runtime::WithoutSignature(bytes);  // the signature is not verified
  const std::size_t index = ChannelNamed(channel);
  if (index < kNumChannels && bytes.size() >= runtime::kHeaderEnd) {
    const std::int64_t run_id = runtime::ReadInt64(bytes, runtime::kRunIdOffset);
    if (KnownTypes()[index].decodes(bytes)) {
      return AddToRun(RunOf(run_id), index, bytes, now);
    }
    // The message cannot be decoded, but its header may name a run.
    if (RunRecord* run = FindRun(run_id); run != nullptr) {
      ChannelRecord& record = run->channels[index];
      record.any = true;
      record.arrivals.Add(bytes.size(), now);
      return CountUndecodable(bytes, record.undecodable);
    }
  }
  ChannelRecord& record = OtherOf(channel);
  record.arrivals.Add(bytes.size(), now);
  record.newest.assign(bytes.begin(), bytes.end());
  if (index < kNumChannels) {
    record.type = KnownTypes()[index].name;
    CountUndecodable(bytes, record.undecodable);
  } else {
    record.type = TypeNameOf(bytes);
  }
}

void TrafficStatistics::AddToRun(RunRecord& run, std::size_t channel, runtime::Bytes bytes,
                                 TimePoint now) {
  ChannelRecord& record = run.channels[channel];
  record.any = true;
  record.type = KnownTypes()[channel].name;
  record.arrivals.Add(bytes.size(), now);
  record.newest.assign(bytes.begin(), bytes.end());
  run.heard = now;
  if (kChannels[channel].pace == Pace::kStep) {
    if (!record.steps) record.steps.emplace();
    record.steps->Add(runtime::ReadInt64(bytes, runtime::kStepOffset), now);
  } else if (channel == IndexOf<run_t>()) {
    AddRun(run, bytes);
  } else if (channel == IndexOf<status_t>()) {
    AddStatus(run, bytes, now);
  }
}

void TrafficStatistics::AddRun(RunRecord& run, runtime::Bytes bytes) {
  run_t message{};
  if (!runtime::Decode(bytes, message)) return;
  run.phase = message.phase;
  run.pace = message.pace;
  run.realtime = message.realtime != 0;
  run.scenario_hash = message.scenario_hash;
}

void TrafficStatistics::AddStatus(RunRecord& run, runtime::Bytes bytes, TimePoint now) {
  status_t status{};
  if (!runtime::Decode(bytes, status)) return;
  for (RoleRecord& role : run.roles) {
    if (role.status.instance != status.instance || role.status.role != status.role) continue;
    if (status.sequence <= role.status.sequence) return;  // repeated, or older than the last one
    role.status = std::move(status);
    role.heard = now;
    return;
  }
  if (run.roles.size() == kMaxRoles) {
    run.roles.erase(std::ranges::min_element(run.roles, {}, &RoleRecord::heard));
    ++forgotten_;
  }
  run.roles.push_back({.status = status,
                       .heard = now,
                       .base_cpu_ms = status.cpu_ms,
                       .base = now,
                       .cpu_percent = std::nullopt});
}

TrafficStatistics::RunRecord* TrafficStatistics::FindRun(std::int64_t run_id) {
  const auto run = std::ranges::find(runs_, run_id, &RunRecord::run_id);
  return run == runs_.end() ? nullptr : &*run;
}

TrafficStatistics::RunRecord& TrafficStatistics::RunOf(std::int64_t run_id) {
  if (RunRecord* run = FindRun(run_id); run != nullptr) return *run;
  if (runs_.size() == kMaxRuns) {
    runs_.erase(std::ranges::min_element(runs_, {}, &RunRecord::heard));
    ++forgotten_;
  }
  RunRecord& run = runs_.emplace_back();
  run.run_id = run_id;
  return run;
}

TrafficStatistics::ChannelRecord& TrafficStatistics::OtherOf(std::string_view channel) {
  if (const auto other = others_.find(channel); other != others_.end()) return other->second;
  ++unknown_names_;
  if (others_.size() == kMaxOthers) {
    others_.erase(std::ranges::min_element(
        others_, {}, [](const auto& other) { return other.second.arrivals.last(); }));
    ++forgotten_;
  }
  return others_[std::string(channel)];
}

TrafficView TrafficStatistics::Observe(TimePoint now) {
  const Duration interval = now - observed_;
  observed_ = now;
  TrafficView view{.interval_s = Seconds(interval), .forgotten = forgotten_};
  for (RunRecord& run : runs_) {
    RunView& shown = view.runs.emplace_back(RunView{.run_id = run.run_id,
                                                    .phase = run.phase,
                                                    .pace = run.pace,
                                                    .realtime = run.realtime,
                                                    .scenario_hash = run.scenario_hash});
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      ChannelRecord& record = run.channels[i];
      if (!record.any) continue;
      shown.channels.push_back(ObserveChannel(kChannels[i].name, record, now, interval));
      if (const auto& steps = shown.channels.back().steps) {
        shown.step = std::max(shown.step, steps->newest);
      }
    }
    shown.roles = ObserveRoles(run, now);
  }
  for (auto& [name, record] : others_) {
    view.others.push_back(ObserveChannel(name, record, now, interval));
  }
  return view;
}

ChannelView TrafficStatistics::ObserveChannel(std::string_view name, ChannelRecord& record,
                                              TimePoint now, Duration interval) {
  ChannelView view{.channel = std::string(name),
                   .type = record.type,
                   .arrivals = record.arrivals.Observe(now, interval),
                   .undecodable = record.undecodable,
                   .newest = record.newest};
  if (record.steps) view.steps = record.steps->counts();
  return view;
}

void TrafficStatistics::ForgetFollowed(std::vector<RoleRecord>& roles, TimePoint now) {
  std::map<std::string, TimePoint> newest;
  for (const RoleRecord& role : roles) {
    TimePoint& heard = newest[role.status.role];
    heard = std::max(heard, role.heard);
  }
  std::erase_if(roles, [&newest, now](const RoleRecord& role) {
    return now - role.heard > kFollowed && newest[role.status.role] > role.heard;
  });
}

std::vector<RoleView> TrafficStatistics::ObserveRoles(RunRecord& run, TimePoint now) {
  ForgetFollowed(run.roles, now);
  std::vector<RoleView> views;
  for (RoleRecord& role : run.roles) {
    if (role.heard > role.base) {
      // The type is double, because the counters come from the network, and their difference may
      // overflow an integer.
      const double cpu_ms =
          static_cast<double>(role.status.cpu_ms) - static_cast<double>(role.base_cpu_ms);
      role.cpu_percent = 100 * 1e-3 * cpu_ms / Seconds(role.heard - role.base);
      role.base = role.heard;
      role.base_cpu_ms = role.status.cpu_ms;
    }
    views.push_back({.status = role.status,
                     .cpu_percent = role.cpu_percent,
                     .age_s = Seconds(now - role.heard),
                     .silent = now - role.heard > kSilent});
  }
  const auto place = [](const RoleView& view) {
    return std::ranges::find(kRoles, view.status.role, &RoleInfo::name) - kRoles.begin();
  };
  std::ranges::stable_sort(views, {}, place);
  return views;
}

}  // namespace fogline::watch
