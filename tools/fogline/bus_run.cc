#include "tools/fogline/bus_run.h"

#include <sodium.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "services/acc/acc.h"
#include "services/arbitrator/arbitrator.h"
#include "services/driver/driver.h"
#include "services/follower/follower.h"
#include "services/fusion/fusion.h"
#include "services/lidar/lidar.h"
#include "services/radar/radar.h"
#include "services/recorder/event_log.h"
#include "services/recorder/recorder.h"
#include "services/runtime/beacon.h"
#include "services/runtime/conductor.h"
#include "services/runtime/fallback_log.h"
#include "services/runtime/lcm_url.h"
#include "services/runtime/runner_watch.h"
#include "services/runtime/step_node.h"
#include "services/world/world.h"
#include "tools/fogline/external_roles.h"
#include "tools/fogline/interrupt.h"
#include "tools/fogline/progress.h"
#include "tools/fogline/relay_process.h"
#include "tools/fogline/supervisor.h"

namespace fogline {
namespace {

// How long a role may take to be ready.
constexpr Duration kJoinLimit = milliseconds(10'000);
// How often the runner looks after its processes while no message comes.
constexpr Duration kLookEvery = milliseconds(20);
// How often it looks whether roles that it waits for are in other runs.
constexpr Duration kLookForExternal = milliseconds(100);
// A process that is silent for so long hangs: ten of its signs of life.
constexpr Duration kHangLimit = milliseconds(2000);
// In real time half of that: whoever needs the process has done without it for long, and a sign of
// life that is lost is no repair's business.
constexpr Duration kRealtimeHangLimit = milliseconds(1000);

ConductorOptions MakeConductorOptions(const Scenario& scenario, const ExperimentOptions& options) {
  // A slow pace is no stall: a step is expected to take its time.
  const std::chrono::duration<double> step(options.pace > 0 ? scenario.step_s / options.pace : 0.0);
  return {.run_id = DrawRunId(),
          .scenario_text = PrintScenario(scenario),
          .steps = scenario.steps,
          .pace = options.pace,
          .realtime = options.realtime,
          .join_limit = options.external.empty() ? kJoinLimit : Duration::zero(),
          .stall_limit = options.stall_limit + duration_cast<Duration>(step),
          .external = options.external,
          .restarts = options.restarts};
}

// ---- memq --------------------------------------------------------------------------------------

template <class Algorithm>
std::unique_ptr<Node> MakeNode(Bus& bus, std::int64_t run_id) {
  return std::make_unique<StepNode<Algorithm>>(bus, run_id);
}

void RunInMemory(Bus& bus, Conductor& conductor, std::int64_t run_id, const Scenario& scenario,
                 const std::filesystem::path& log) {
  std::vector<std::unique_ptr<Node>> nodes;
  for (const auto make :
       {MakeNode<World>, MakeNode<Radar>, MakeNode<Lidar>, MakeNode<Fusion>, MakeNode<Acc>,
        MakeNode<Driver>, MakeNode<Arbitrator>, MakeNode<Follower>}) {
    nodes.push_back(make(bus, run_id));
  }
  nodes.push_back(std::make_unique<Recorder>(bus, run_id, log));
  Progress progress("step", scenario.steps);
  while (conductor.phase() == Conductor::Phase::kJoining ||
         conductor.phase() == Conductor::Phase::kRunning) {
    const TimePoint now = Clock::now();
    TimePoint next = conductor.Poll(now);
    for (const auto& node : nodes) next = std::min(next, node->Poll(now));
    // Messages first: while there are any, nothing is due by the clock.
    if (bus.Wait(next - Clock::now())) bus.Drain();
    progress.Show(conductor.step());
    if (WasInterrupted()) break;
  }
  conductor.Stop();
  bus.Drain();
}

// ---- processes ---------------------------------------------------------------------------------

void AnnounceProcesses(const Bus& bus, std::int64_t run_id, const ProcessGroup& group,
                       const std::string& external) {
  fmt::print(stderr, "run {} on {}\n", run_id, bus.url());
  if (!group.empty()) fmt::print(stderr, "processes: {}\n", group.Describe());
  fmt::print(stderr, "{}", external);
}

/// Names once each process that has a role for which the run waits, but is in another run.
class BusyElsewhere {
 public:
  explicit BusyElsewhere(std::function<void(const std::string&)> say) : say_(std::move(say)) {}

  void Look(const Conductor& conductor, TimePoint now) {
    if (now < look_at_) return;
    look_at_ = now + kLookForExternal;
    const std::vector<Role> awaited = conductor.Awaited(now);
    if (awaited.empty()) return;
    for (const Stranger& stranger : conductor.strangers().known()) {
      const std::string who = Describe(stranger);
      const bool is_awaited = std::ranges::any_of(
          awaited, [&stranger](Role role) { return NameOf(role) == stranger.role; });
      if (!is_awaited || !told_.insert(who).second) continue;
      say_(
          fmt::format("{} is not free: it comes when that run is over, or when its runner has "
                      "been silent for {:g} s",
                      who, Seconds(RunnerWatch::kSilent)));
    }
  }

 private:
  std::function<void(const std::string&)> say_;
  std::set<std::string> told_;
  TimePoint look_at_{};
};

std::vector<Restarts> RunAsProcesses(Bus& bus, Conductor& conductor, RelayProcess* relay,
                                     std::int64_t run_id, const Scenario& scenario,
                                     const ExperimentOptions& options,
                                     const std::filesystem::path& log) {
  Progress progress("step", scenario.steps);
  Beacon beacon({.run_id = run_id, .url = bus.url(), .scenario = scenario.title});
  const ExternalRoles external(bus.url(), options.traffic, options.wait);
  const auto say = [&](const std::string& line) {
    if (options.announce) progress.Say(line);
  };
  BusyElsewhere elsewhere(say);
  Supervisor supervisor(bus, conductor,
                        {.url = bus.url(),
                         .run_id = run_id,
                         .log = log,
                         .arguments = ToArguments(options.traffic),
                         .external = options.external,
                         .restarts = options.restarts,
                         // Whoever hangs is found before the run counts as stalled.
                         .silence = std::min(options.realtime ? kRealtimeHangLimit : kHangLimit,
                                             options.stall_limit / 2),
                         .say = say});
  if (options.announce) {
    AnnounceProcesses(bus, run_id, supervisor.group(), external.Text(options.external));
  }
  std::string trouble;
  FallbackLog fallbacks(std::llround(scenario.step_s * 1e6), options.pace, scenario.steps);
  if (options.realtime && options.announce) {
    conductor.OnEveryStatus([&](const status_t& status) {
      if (const Fallback* change = fallbacks.Add(status)) progress.Say(change->Text());
    });
  }
  try {
    while (conductor.phase() == Conductor::Phase::kJoining ||
           conductor.phase() == Conductor::Phase::kRunning) {
      const TimePoint now = Clock::now();
      const TimePoint next = std::min(conductor.Poll(now), now + kLookEvery);
      if (const Duration away = conductor.TakeAway(); away > Duration::zero() && options.announce) {
        progress.Say(fmt::format("warning: the runner was held up for {:.1f} s {}",
                                 std::chrono::duration<double>(away).count(), conductor.Where()));
      }
      if (bus.Wait(next - now)) bus.Drain();
      supervisor.Look(Clock::now());
      if (relay != nullptr) {
        if (const std::string news = relay->Look(conductor, now); !news.empty()) say(news);
      }
      elsewhere.Look(conductor, now);
      external.Check(conductor, now);
      if (beacon.Due(now)) beacon.Send(now, conductor.Awaited(now));
      progress.Show(conductor.step());
      if (options.announce && trouble.empty()) {
        trouble = conductor.KeyTrouble();
        if (!trouble.empty()) progress.Say(fmt::format("warning: {}", trouble));
      }
      if (WasInterrupted()) break;
    }
  } catch (const std::exception& error) {
    conductor.Fail(error.what());  // the processes are still ended in order
  }
  supervisor.End();
  return supervisor.restarts();
}

/// Whether a file is the log of a run, which begins with its scenario. A run that is to replace an
/// older log may end before it has begun to.
bool IsLogOf(std::int64_t run_id, const std::filesystem::path& file) {
  try {
    EventLogReader reader(file);
    const std::optional<Event> first = reader.Next();
    return first && first->data.size() >= kHeaderEnd &&
           ReadInt64(first->data, kRunIdOffset) == run_id;
  } catch (const InputError&) {
    return false;
  }
}

/// What a run that ends early has left; "" if it was to leave no log.
std::string KeptLog(std::int64_t run_id, const std::filesystem::path& log) {
  if (log.empty()) return "";
  return IsLogOf(run_id, log) ? fmt::format("the log so far: {}", log.string())
                              : "no log was written";
}

std::string UrlOf(const std::string& transport) {
  if (transport == "memq") return "memq://";
  if (transport == "udpm") return FreshMulticastUrl();
  if (IsLcmUrl(transport)) return transport;
  throw InputError(
      fmt::format("error: --transport {}: neither direct, memq, udpm, tcpq nor an LCM URL such as "
                  "\"udpm://239.255.76.67:7667?ttl=0\"",
                  transport));
}

}  // namespace

std::int64_t DrawRunId() {
  std::uint64_t id = 0;
  randombytes_buf(&id, sizeof(id));
  return static_cast<std::int64_t>(id >> 2) + 1;  // positive, so that it reads well
}

BusRun RunOnBus(const Scenario& scenario, const ExperimentOptions& options,
                const std::filesystem::path& log) {
  std::optional<RelayProcess> relay;
  if (options.transport == "tcpq") relay.emplace(options.restarts);
  Bus bus(relay ? relay->url() : UrlOf(options.transport));
  const bool in_memory = bus.url().starts_with("memq");
  Apply(options.traffic, in_memory ? std::nullopt : std::optional(Role::kRunner), bus);
  const ConductorOptions conducting = MakeConductorOptions(scenario, options);
  Conductor conductor(bus, conducting);
  const TimePoint began = Clock::now();
  std::vector<Restarts> restarts;
  if (in_memory) {
    RunInMemory(bus, conductor, conducting.run_id, scenario, log);
  } else {
    restarts = RunAsProcesses(bus, conductor, relay ? &*relay : nullptr, conducting.run_id,
                              scenario, options, log);
    if (relay && relay->restarts() > 0) {
      restarts.push_back({.role = "relay", .count = relay->restarts(), .last = relay->death()});
    }
  }
  const std::string kept = KeptLog(conducting.run_id, options.log);
  // Said whatever the end: a role that is missing may be one that is bound to another run.
  const std::string strangers = conductor.strangers().Text();
  if (options.announce && !strangers.empty()) fmt::print(stderr, "{}\n", strangers);
  if (conductor.phase() == Conductor::Phase::kFailed) {
    throw std::runtime_error(conductor.error() + (kept.empty() ? "" : "\n  " + kept));
  }
  if (conductor.phase() != Conductor::Phase::kDone) {
    const std::string where = conductor.phase() == Conductor::Phase::kJoining
                                  ? fmt::format("while waiting for {}", conductor.NotReady())
                                  : conductor.Where();
    throw Interrupted(fmt::format("interrupted {}{}{}", where, kept.empty() ? "" : "; ", kept));
  }
  return {.run_id = conducting.run_id,
          .wall_s = std::chrono::duration<double>(Clock::now() - began).count(),
          .repairs = conductor.Total(&status_t::repairs_asked),
          .refused = conductor.Refused(),
          .send_troubles = conductor.SendTroubles(),
          .strangers = conductor.strangers().known(),
          .restarts = std::move(restarts)};
}

}  // namespace fogline
