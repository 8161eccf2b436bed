#include "tools/runner/scenario_run.h"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/file.h"
#include "common/interrupt.h"
#include "common/text.h"
#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "services/log/about/log_graph.h"
#include "services/log/undecodable.h"
#include "services/metrics/sample_decoder.h"
#include "services/metrics/take_over/take_over_accumulator.h"
#include "services/models/traffic/load_sumo.h"
#include "services/runtime/wire/digest.h"
#include "tools/runner/bus_run.h"
#include "tools/runner/direct_log.h"
#include "tools/runner/log_sealer.h"
#include "tools/runner/person_measures.h"
#include "tools/runner/unfinished_log_text.h"

namespace fogline::runner {
namespace {

// The shortest step of a run in real time, in seconds of wall-clock time. In this time nine
// processes must send and receive the messages of a step. The STATUS messages of these processes
// must arrive within 64 steps.
constexpr double kMinPeriodS = 0.005;

/// A temporary directory; the destructor removes it.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (TemporaryFolder() / "fogline-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error(fmt::format("cannot make a temporary directory {}", name));
    }
    path_ = name;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Adds the messages of a step to a digest and a log, in the order of the graph table.
class StepWriter {
 public:
  StepWriter(runtime::Digest& digest, DirectLog* log) : digest_(digest), log_(log) {}

  void Add(const closed_loop::StepView& step) {
    step.ForEachMessage([this](const auto& message) { AddOne(message); });
  }

 private:
  template <class M>
  void AddOne(const M& message) {
    runtime::Encode(message, buffer_);
    digest_.Add(buffer_);
    if (log_ == nullptr) return;
    log_->Add(message.header.step, ChannelOf<M>(), message.header.utime, buffer_);
  }

  runtime::Digest& digest_;
  DirectLog* log_;
  std::vector<std::uint8_t> buffer_;
};

RunResult Compute(const Scenario& scenario, const RunOptions& options, std::int64_t run_id) {
  std::optional<DirectLog> log;
  if (!options.log.empty()) log.emplace(options, run_id, scenario);
  RunResult result;
  runtime::Digest digest;
  StepWriter writer(digest, log ? &*log : nullptr);
  metrics::MetricsAccumulator measures(scenario);
  metrics::FollowerAccumulator followers;
  metrics::TakeOverAccumulator take_overs;
  const TimePoint began = Clock::now();
  closed_loop::ClosedLoop loop(scenario);
  loop.Run(run_id, [&](const closed_loop::StepView& step) {
    writer.Add(step);
    const metrics::Sample sample = step.ToSample();
    measures.Add(sample);
    followers.Add(step.truth, step.follower);
    take_overs.Add(step.truth, &step.host, &step.track, step.driver.acceleration_mps2);
    if (options.samples) result.samples.push_back(sample);
    ++result.steps;
    if (log && result.steps == 1) {
      log->Flush();
      options.on_logged_step();
    }
    if (!WasInterrupted()) return;
    if (log) log->CutOff();
    throw Interrupted(fmt::format("interrupted at step {}", sample.step));
  });
  if (log) log->Flush();
  result.wall_s = std::chrono::duration<double>(Clock::now() - began).count();
  result.seed = scenario.seed;
  result.digest = digest.Hex();
  result.measures = measures.Result();
  result.followers = followers.Result();
  result.take_overs = take_overs.Result();
  result.log = options.log;
  if (log) log->End(result);
  return result;
}

RunResult RunDirect(const Scenario& scenario, const RunOptions& options) {
  const std::int64_t run_id = options.resume ? options.resume->front.run_id : RunIdOf(options);
  try {
    return Compute(scenario, options, run_id);
  } catch (const Interrupted& interrupted) {
    const std::string unfinished = UnfinishedLogText(run_id, options);
    throw Interrupted(
        fmt::format("{}{}{}", interrupted.what(), unfinished.empty() ? "" : "; ", unfinished));
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    const std::string unfinished = UnfinishedLogText(run_id, options);
    throw std::runtime_error(
        fmt::format("{}{}{}", error.what(), unfinished.empty() ? "" : "\n  ", unfinished));
  }
}

/// The measures of a run that need the messages themselves, and not only the samples.
class MessageMeasures {
 public:
  /// Adds a step. @param messages shows which messages the step has
  void Add(const log::StepMessages& messages, const metrics::SampleDecoder& decoder) {
    followers_.Add(decoder.truth(), decoder.follower());
    const bool commanded = !messages[IndexOf<arbitration_t>()].empty();
    const bool fused = !messages[IndexOf<track_t>()].empty();
    const bool offered = !messages[IndexOf<driver_command_t>()].empty();
    const driver_command_t& driver = decoder.driver();
    take_overs_.Add(decoder.truth(), commanded ? &decoder.host() : nullptr,
                    fused ? &decoder.track() : nullptr,
                    offered ? std::optional(driver.acceleration_mps2) : std::nullopt);
    if (offered && driver.input_instance != 0) seats_.insert(driver.input_instance);
  }

  /// @param run has the scenario and the name of the log
  /// @param has_end whether the log has the last step
  void PutInto(LoggedRun& run, bool has_end) const {
    run.result.followers = followers_.Result();
    run.result.take_overs = take_overs_.Result();
    run.result.lack.beginning_of_request = take_overs_.BeganInRequest();
    AddPersonMeasures(seats_, run);
    if (!has_end) take_overs_.CutOff(run.result.take_overs);
  }

 private:
  metrics::FollowerAccumulator followers_;
  metrics::TakeOverAccumulator take_overs_;
  std::set<std::int64_t> seats_;
};

/// Reads a run from its log, without the measures that need only the samples.
/// @param use gets the sample of each step
template <class Use>
LoggedRun ReadSteps(const std::filesystem::path& log, const log::ReadOptions& options,
                    const Use& use) {
  LoggedRun logged;
  MessageMeasures measures;
  metrics::SampleDecoder decoder;
  std::optional<std::int64_t> first;  // the first step with TRUTH
  runtime::ChannelSet heard;          // the channels with a message in some step that has TRUTH
  bool has_last = false;              // whether the log has the TRUTH of the last step
  const runtime::ChannelSet all = log::OwnStepChannels();
  log::RunLogReader reader(log, options);
  while (const log::StepMessages* messages = reader.Next()) {
    if (reader.InTail()) continue;
    const runtime::ChannelSet there = log::ChannelsIn(*messages);
    if (!there[IndexOf<truth_t>()]) continue;  // the state of the step is unknown
    heard |= there;
    const bool holes = (all & ~there).any();
    const metrics::Sample* sample =
        holes ? decoder.DecodeWithHoles(*messages) : decoder.Decode(*messages);
    if (sample == nullptr) {
      throw InputError(
          fmt::format("{}: error: {}", PathText(log),
                      log::DoesNotDecode(fmt::format("step {} of {}", reader.step(),
                                                     log::FirstUndecodable(*messages)))));
    }
    if (!first) first = sample->step;
    has_last = sample->last;
    use(*sample);
    measures.Add(*messages, decoder);
  }
  static_cast<log::RunLog&>(logged) = reader.run();
  logged.result.seed = logged.scenario.seed;
  logged.result.steps = logged.steps;
  logged.result.digest = logged.digest;
  logged.result.log = log;
  logged.result.realtime = logged.realtime;
  metrics::Lack& lack = logged.result.lack;
  for (std::size_t i = 0; i < kNumChannels; ++i) lack.channels[i] = logged.gaps.Lacks(i);
  if (logged.realtime) lack.channels = logged.realtime->unlogged_channels;
  lack.every = all & ~heard;
  lack.last = lack.channels[IndexOf<truth_t>()] && !has_last;
  lack.beginning = first.value_or(0) > 0;
  lack.end = !has_last && !logged.ended;
  measures.PutInto(logged, !lack.end);
  if (!metrics::AreTakeOversKnown(lack)) logged.result.take_overs.clear();
  return logged;
}

/// Compares the log with the recorder's reports, and reads the log.
LoggedRun ReadOwnLog(const LogSealer& sealer, const std::filesystem::path& log, const BusRun& run,
                     const Scenario& scenario, const RunOptions& options) {
  const auto read = [&] {
    const log::ReadOptions whole{.has_all = true};
    LoggedRun logged =
        options.samples ? ReadLoggedRun(log, whole) : MeasureLoggedRun(log, scenario, whole);
    if (logged.run_id == run.run_id) return logged;
    throw std::runtime_error(
        fmt::format("{}: the log is of run {}, not of this run, {}: it was replaced meanwhile",
                    PathText(log), logged.run_id, run.run_id));
  };
  try {
    sealer.Check(run.written);
  } catch (const std::runtime_error&) {
    try {
      read();  // throws a clearer error for a log of another run
    } catch (const InputError&) {
    }
    throw;
  }
  LoggedRun logged = read();
  if (logged.ended) return logged;
  throw std::runtime_error(
      fmt::format("{}: the log is not complete: {}", PathText(log), logged.note));
}

/// Reads, verifies and seals the log of a run that has ended.
RunResult ReadResult(const LogSealer& sealer, const std::filesystem::path& log, BusRun run,
                     const Scenario& scenario, const RunOptions& options) {
  LoggedRun logged = ReadOwnLog(sealer, log, run, scenario, options);
  const auto key = runtime::KeyOf(options.traffic);
  const bool checked = sealer.HasAllTold(run.written);
  if (!checked && !options.realtime) {
    throw std::runtime_error(
        fmt::format("{}: the log on disk is longer than what the recorder wrote", PathText(log)));
  }
  if (!checked && key) {
    throw std::runtime_error(
        fmt::format("{}: the log cannot be signed, because the recorder's last report was lost",
                    PathText(log)));
  }
  RunResult result = std::move(logged.result);
  const bool elsewhere = !options.external.empty() || !options.hosts.empty();
  if (options.verify.value_or(options.resume || elsewhere)) {
    result.verification = replay::VerifyRun(log, logged, run.other_builds);
  }
  if (checked && !options.log.empty()) {
    sealer.Seal(logged, run.written, {.builds = run.builds, .priority = run.priority},
                key ? &*key : nullptr);
  }
  result.checked = checked;
  result.wall_s = run.wall_s;
  result.repairs = run.repairs;
  result.refused = run.refused;
  result.send_troubles = std::move(run.send_troubles);
  result.foreign_peers = run.foreign_peers;
  result.restarts = std::move(run.restarts);
  if (result.realtime) result.realtime->priority = std::move(run.priority);
  result.other_builds = std::move(run.other_builds);
  result.log = options.log;
  return result;
}

RunResult RunLogged(const Scenario& scenario, const RunOptions& options) {
  std::optional<TemporaryDirectory> scratch;
  std::filesystem::path log = options.log;
  if (log.empty()) log = scratch.emplace().path() / "run.lcm";
  const LogSealer sealer(log);
  BusRun run = RunOnBus(scenario, options, log, sealer);
  try {
    return ReadResult(sealer, log, std::move(run), scenario, options);
  } catch (const InputError& error) {  // the log was changed since the recorder wrote it
    throw std::runtime_error(error.what());
  }
}

}  // namespace

void CheckPossible(const Scenario& scenario, const std::filesystem::path& file) {
  try {
    const closed_loop::ClosedLoop parts(scenario);
    // SUMO reads its network and its routes only when a run begins. To find mistakes in them, the
    // world is started here.
    if (scenario.lead.profile == LeadProfile::kSumo) world::World(scenario).Start(0);
  } catch (const InputError& error) {
    // The text is "/pointer: message", or only a message if no single field is the cause.
    const std::string what = error.what();
    const std::size_t colon = what.starts_with('/') ? what.find(": ") : std::string::npos;
    const bool field = colon != std::string::npos;
    throw ScenarioError(fmt::format("{}: error: {}", PathText(file), what),
                        {{.file = file.string(),
                          .pointer = field ? what.substr(0, colon) : "",
                          .rule = "impossible",
                          .message = field ? what.substr(colon + 2) : what}});
  }
}

std::string WhyTooFast(const Scenario& scenario, double speed) {
  const double period_s = scenario.step_s / speed;
  if (period_s >= kMinPeriodS) return "";
  return fmt::format("a step of {:g} s would take {:.3g} ms of wall clock; the shortest is {:g} ms",
                     scenario.step_s, 1e3 * period_s, 1e3 * kMinPeriodS);
}

RunResult RunScenario(const Scenario& scenario, const RunOptions& options) {
  if (scenario.lead.profile == LeadProfile::kSumo && scenario.lead.sumo.version.empty()) {
    // The log names SUMO's version, because only this version computes the same run again.
    Scenario stated = scenario;
    stated.lead.sumo.version = models::SumoVersion();
    return RunScenario(stated, options);
  }
  RunResult result =
      options.transport == "direct" ? RunDirect(scenario, options) : RunLogged(scenario, options);
  result.transport = options.transport;
  return result;
}

LoggedRun ReadLoggedRun(const std::filesystem::path& log, const log::ReadOptions& options) {
  std::vector<metrics::Sample> samples;
  LoggedRun logged =
      ReadSteps(log, options, [&](const metrics::Sample& sample) { samples.push_back(sample); });
  logged.result.measures = metrics::Measure(samples, logged.scenario);
  logged.result.samples = std::move(samples);
  return logged;
}

LoggedRun MeasureLoggedRun(const std::filesystem::path& log, const Scenario& scenario,
                           const log::ReadOptions& options) {
  metrics::MetricsAccumulator measures(scenario);
  LoggedRun logged =
      ReadSteps(log, options, [&](const metrics::Sample& sample) { measures.Add(sample); });
  logged.result.measures = measures.Result();
  return logged;
}

}  // namespace fogline::runner
