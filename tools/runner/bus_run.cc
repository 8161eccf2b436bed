#include "tools/runner/bus_run.h"

#include <sodium.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/process/progress.h"
#include "common/process/signals_blocked.h"
#include "scenario/io/loader.h"
#include "services/closed_loop/algorithms.h"
#include "services/recorder/recorder.h"
#include "services/runtime/coordination/run_coordinator.h"
#include "services/runtime/discovery/beacon.h"
#include "services/runtime/process/step_node.h"
#include "services/runtime/realtime/fallback_log.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tools/hosts/host_group.h"
#include "tools/processes/child.h"
#include "tools/processes/external_roles.h"
#include "tools/processes/relay_process.h"
#include "tools/runner/role_news.h"
#include "tools/runner/supervisor.h"
#include "tools/runner/unfinished_log_text.h"

namespace fogline::runner {
namespace {

// Time in which a role has to be ready.
constexpr Duration kJoinLimit = milliseconds(10'000);
// Interval at which the runner checks its processes while no message arrives.
constexpr Duration kLookEvery = milliseconds(20);
// A process without a STATUS for this long counts as hanging. A living process sends ten STATUS
// messages in this time.
constexpr Duration kHangLimit = milliseconds(2000);
// In real time the limit is half of kHangLimit: other roles do not wait for a hanging process, so
// it must be restarted soon. The limit still covers five STATUS messages, because a lost STATUS is
// not sent again.
constexpr Duration kRealtimeHangLimit = milliseconds(1000);

/// The builds of the programs in the folder of the runner. A role that is started elsewhere may
/// have another build.
runtime::RoleBuilds OwnBuilds(bool in_memory) {
  runtime::RoleBuilds builds{};
  for (const RoleInfo& info : kRoles) {
    builds[static_cast<std::size_t>(info.role)] =
        in_memory ? runtime::OwnBuildId() : runtime::BuildIdOf(processes::ProgramOf(info.role));
  }
  return builds;
}

/// First sequence number of a runner that replaces another runner, or whose run id may have been
/// used before. Roles of the old runner may still be alive, and they obey the newest runner. A
/// runner sends less than one message per microsecond, so the current time in microseconds exceeds
/// every number of the old runner.
std::int64_t NewerThanEveryRunner() {
  using std::chrono::microseconds;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<microseconds>(now).count();
}

/// Starts a thread that sends signs of life to the other machines until it is asked to stop. If a
/// connection ends meanwhile, the start of the roles there fails and says so.
std::jthread KeepAlive(const hosts::HostGroup* hosts) {
  if (hosts == nullptr) return {};
  const SignalsBlocked blocked;  // only the runner's thread handles signals
  return std::jthread([hosts](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      hosts->KeepAlive();
      std::this_thread::sleep_for(kLookEvery);
    }
  });
}

runtime::RunCoordinatorOptions MakeCoordinatorOptions(const Scenario& scenario,
                                                      const RunOptions& options, bool in_memory) {
  // The duration of a step at this pace. It is added to the stall limit, because a slow pace is not
  // a stall.
  const std::chrono::duration<double> step(options.pace > 0 ? scenario.step_s / options.pace : 0.0);
  const auto& resume = options.resume;
  return {.run_id = resume ? resume->front.run_id : RunIdOf(options),
          .scenario_text = resume ? resume->front.parts.Text() : PrintScenario(scenario),
          .steps = scenario.steps,
          .progress = resume ? resume->remains.steps - 1 : -1,
          .sequence = resume || options.run_id ? NewerThanEveryRunner() : 0,
          .pace = options.pace,
          .realtime = options.realtime,
          .period = duration_cast<Duration>(step),
          .join_limit = kJoinLimit,
          .prepare_limit = Supervisor::kPrepareLimit,
          .stall_limit = options.stall_limit + duration_cast<Duration>(step),
          .external = options.external,
          .restarts = options.restarts,
          .builds = OwnBuilds(in_memory),
          .same_build = options.same_build};
}

/// Calls options.on_logged_step if the log has a step. The recorder's STATUS names only steps that
/// the recorder has handed to the operating system. A recorder that has failed may name the step
/// that it could not write.
void TellLoggedStep(const runtime::RunCoordinator& coordinator, const RunOptions& options) {
  const auto& recorder = coordinator.member(Role::kRecorder).status;
  if (recorder && recorder->state != status_t::FAILED && recorder->header.step >= 0) {
    options.on_logged_step();
  }
}

// ---- memq --------------------------------------------------------------------------------------

void RunInMemory(runtime::Bus& bus, runtime::RunCoordinator& coordinator, std::int64_t run_id,
                 const Scenario& scenario, const RunOptions& options,
                 const std::filesystem::path& log) {
  std::vector<std::unique_ptr<runtime::Work>> roles;
  [&]<class... A>(std::type_identity<std::tuple<A...>>) {
    (roles.push_back(std::make_unique<runtime::StepNode<A>>(bus, run_id)), ...);
  }(std::type_identity<closed_loop::Algorithms>{});
  roles.push_back(std::make_unique<recorder::Recorder>(
      bus, run_id, log,
      options.resume ? recorder::Recorder::Existing::kResume
                     : recorder::Recorder::Existing::kReplace,
      options.wall_clock ? recorder::Recorder::WallClock::kYes
                         : recorder::Recorder::WallClock::kNo));
  Progress progress("step", scenario.steps, options.progress);
  while (coordinator.phase() == runtime::RunCoordinator::Phase::kJoining ||
         coordinator.phase() == runtime::RunCoordinator::Phase::kRunning) {
    const TimePoint now = Clock::now();
    TimePoint next = coordinator.Poll(now);
    for (const auto& role : roles) next = std::min(next, role->node().Poll(now));
    // All waiting messages are handled before the next call of Poll().
    if (bus.Wait(next - Clock::now())) bus.Drain();
    progress.Show(coordinator.step());
    TellLoggedStep(coordinator, options);
    if (WasInterrupted()) break;
  }
  coordinator.Stop();
  bus.Drain();
}

// ---- processes ---------------------------------------------------------------------------------

void AnnounceProcesses(const runtime::Bus& bus, std::int64_t run_id, const std::string& started,
                       const std::string& external) {
  Notice(fmt::format("run {} on {}", run_id, bus.url()));
  if (!started.empty()) Notice(fmt::format("processes: {}", started));
  if (!external.empty()) Notice(external);
}

/// What RunAsProcesses() learns about the processes.
struct ProcessNews {
  std::vector<Restarts> restarts;
  std::optional<log::RealtimePriority> priority;
};

ProcessNews RunAsProcesses(runtime::Bus& bus, runtime::RunCoordinator& coordinator,
                           processes::RelayProcess* relay, const hosts::HostGroup* hosts,
                           std::int64_t run_id, const Scenario& scenario, const RunOptions& options,
                           const std::filesystem::path& log) {
  Progress progress("step", scenario.steps, options.progress);
  runtime::Beacon beacon({.run_id = run_id, .url = bus.url(), .scenario = scenario.title});
  processes::ExternalRoles external(bus.url(), options.traffic, options.wait);
  const auto say = [&](const std::string& line) {
    if (options.announce) progress.Say(line);
  };
  BusyElsewhere elsewhere(run_id, say);
  Supervisor supervisor(bus, coordinator,
                        {.url = bus.url(),
                         .run_id = run_id,
                         .log = log,
                         .resume = options.resume.has_value(),
                         .wall_clock = options.wall_clock,
                         .traffic = options.traffic,
                         .external = options.external,
                         .hosts = hosts,
                         .restarts = options.restarts,
                         // A hanging process must be found before the run counts as stalled.
                         .silence = std::min(options.realtime ? kRealtimeHangLimit : kHangLimit,
                                             options.stall_limit / 2),
                         .say = say});
  if (options.announce) {
    AnnounceProcesses(bus, run_id, supervisor.Describe(), external.Text(options.external));
  }
  Warnings warnings(coordinator, progress);
  runtime::FallbackLog fallbacks(std::llround(scenario.step_s * 1e6), options.pace, scenario.steps);
  PriorityWatch priority(options.realtime);
  if (options.realtime && options.announce) {
    coordinator.OnEveryStatus([&](const status_t& status) {
      if (const runtime::Fallback* change = fallbacks.Add(status)) progress.Say(change->Text());
    });
  }
  try {
    while (coordinator.phase() == runtime::RunCoordinator::Phase::kJoining ||
           coordinator.phase() == runtime::RunCoordinator::Phase::kRunning) {
      const TimePoint now = Clock::now();
      const TimePoint next = std::min(coordinator.Poll(now), now + kLookEvery);
      if (options.announce) warnings.LookAtTheClock();
      if (bus.Wait(next - now)) bus.Drain();
      supervisor.Look(Clock::now());
      if (relay != nullptr) {
        if (const std::string news = relay->Look(coordinator, now); !news.empty()) say(news);
      }
      elsewhere.Look(coordinator, now);
      external.Check(coordinator, now);
      if (beacon.Due(now)) beacon.Send(now, coordinator.Awaited(now));
      progress.Show(coordinator.step());
      TellLoggedStep(coordinator, options);
      if (options.announce) warnings.LookAtTheRoles();
      if (priority.Look(coordinator, now)) say(priority.Text());
      if (const auto news = external.News(options.external, coordinator, now); !news.empty()) {
        say(news);
      }
      if (WasInterrupted()) break;
    }
  } catch (const std::exception& error) {
    coordinator.Fail(error.what());  // the code below ends the processes
  }
  supervisor.End();
  return {.restarts = supervisor.restarts(), .priority = priority.found()};
}

/// What each recorder process of a run has written into the log, according to its last STATUS. All
/// these processes except the last one have ended. In real time, a recorder may remove the end of
/// the log that an earlier recorder wrote. So in real time, only the STATUS of the last recorder
/// counts.
std::vector<log::WrittenLog> WrittenBy(const runtime::RunCoordinator& coordinator, bool realtime) {
  std::vector<log::WrittenLog> written;
  for (const status_t& status : LastWords(coordinator, Role::kRecorder)) {
    if (realtime) written.clear();
    written.push_back({.begin = status.log_begin,
                       .bytes = status.log_bytes,
                       .checksum = static_cast<std::uint32_t>(status.log_checksum)});
  }
  return written;
}

/// @param far whether messages must reach other machines
std::string UrlOf(const std::string& transport, bool far) {
  if (transport == "memq") return "memq://";
  if (transport == "udpm") {
    const std::string here = runtime::FreshMulticastUrl();
    const runtime::MulticastAddress address = *runtime::ParseMulticastUrl(here);
    return far ? fmt::format("udpm://{}:{}?ttl=1", address.group, address.port) : here;
  }
  if (runtime::IsLcmUrl(transport)) return transport;
  throw InputError(
      fmt::format("error: --transport {}: neither direct, memq, udpm, tcpq nor an LCM URL such as "
                  "\"udpm://239.255.76.67:7667?ttl=0\"",
                  transport));
}

/// The role in whose name the runner's bus signs messages and applies faults. In memory, the bus
/// does this for every role, so the result is nullopt.
std::optional<Role> SenderOn(const std::string& url) {
  return runtime::IsInMemory(url) ? std::nullopt : std::optional(Role::kRunner);
}

}  // namespace

std::int64_t DrawRunId() {
  std::uint64_t id = 0;
  randombytes_buf(&id, sizeof(id));
  return static_cast<std::int64_t>(id >> 2) + 1;  // positive, for easier reading
}

void CheckNetwork(const RunOptions& options) {
  if (options.transport == "tcpq") return;
  const std::string url = UrlOf(options.transport, !options.hosts.empty());
  runtime::OpenBus(url, options.traffic, SenderOn(url));
}

BusRun RunOnBus(const Scenario& scenario, const RunOptions& options,
                const std::filesystem::path& log, const LogSealer& sealer) {
  const auto hosts = hosts::Connect(options.hosts);
  std::optional<processes::RelayProcess> relay;
  if (options.transport == "tcpq") {
    relay.emplace(options.restarts, hosts ? hosts->RelayPlace() : "127.0.0.1:0");
  }
  runtime::Bus bus(relay ? relay->url() : UrlOf(options.transport, hosts != nullptr));
  const bool in_memory = runtime::IsInMemory(bus.url());
  // If the runner is silent, roles on other machines wait for it for the same time as roles that a
  // person has started: the stall limit plus kGone.
  if (hosts) {
    hosts->Check(bus.url(), options.traffic, options.stall_limit + runtime::RunnerWatch::kGone);
  }
  const runtime::RunCoordinatorOptions conducting =
      MakeCoordinatorOptions(scenario, options, in_memory);
  if (!in_memory) {
    const std::jthread alive = KeepAlive(hosts.get());  // on_network may wait for a person
    options.on_network(conducting.run_id, bus.url());
  }
  runtime::Apply(options.traffic, SenderOn(bus.url()), bus);
  if (!in_memory) options.on_run(conducting.run_id, bus.url());
  runtime::RunCoordinator coordinator(bus, conducting);
  const TimePoint began = Clock::now();
  ProcessNews news;
  if (in_memory) {
    RunInMemory(bus, coordinator, conducting.run_id, scenario, options, log);
  } else {
    news = RunAsProcesses(bus, coordinator, relay ? &*relay : nullptr, hosts.get(),
                          conducting.run_id, scenario, options, log);
    if (relay && relay->restarts() > 0) {
      news.restarts.push_back(
          {.role = "relay", .count = relay->restarts(), .last = relay->death()});
    }
  }
  BusRun run{.run_id = conducting.run_id,
             .wall_s = std::chrono::duration<double>(Clock::now() - began).count(),
             .repairs = coordinator.Total(&status_t::repairs_asked),
             .refused = coordinator.Refused(),
             .send_troubles = coordinator.SendTroubles(),
             .foreign_peers = coordinator.foreign_peers().known(),
             .restarts = std::move(news.restarts),
             .priority = std::move(news.priority)};
  for (const RoleInfo& info : kRoles) {
    const auto& status = coordinator.member(info.role).status;
    if (status) run.builds[static_cast<std::size_t>(info.role)] = status->build_id;
  }
  run.other_builds = OtherBuilds(coordinator);
  run.written = WrittenBy(coordinator, options.realtime);
  if (coordinator.phase() != runtime::RunCoordinator::Phase::kDone && !options.log.empty()) {
    const auto key = runtime::KeyOf(options.traffic);
    sealer.SealCutOff(run.written, {.builds = run.builds, .priority = run.priority},
                      key ? &*key : nullptr);
  }
  const std::string unfinished = UnfinishedLogText(conducting.run_id, options);
  // These peers are printed for every outcome, because a missing role may be in another run.
  const std::string foreign_peers = coordinator.foreign_peers().Text();
  if (options.announce && !foreign_peers.empty()) Notice(foreign_peers);
  if (coordinator.phase() == runtime::RunCoordinator::Phase::kFailed) {
    throw std::runtime_error(coordinator.error() + (unfinished.empty() ? "" : "\n  " + unfinished));
  }
  if (coordinator.phase() != runtime::RunCoordinator::Phase::kDone) {
    throw Interrupted(fmt::format("interrupted {}{}{}", coordinator.WhereOrWaiting(),
                                  unfinished.empty() ? "" : "; ", unfinished));
  }
  return run;
}

}  // namespace fogline::runner
