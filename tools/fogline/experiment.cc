#include "tools/fogline/experiment.h"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "services/measures/sample_decoder.h"
#include "services/recorder/run_log.h"
#include "services/runtime/digest.h"
#include "services/runtime/scenario_parts.h"
#include "tools/fogline/bus_run.h"
#include "tools/fogline/interrupt.h"

namespace fogline {
namespace {

/// A directory for the length of a scope.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "fogline-XXXXXX").string();
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

std::size_t PlaceOf(const ChannelInfo& channel) {
  return static_cast<std::size_t>(&channel - kChannels.data());
}

/// Adds the messages of a step to a digest and a log, in the order of the graph table.
class StepWriter {
 public:
  StepWriter(Digest& digest, EventLogWriter* log) : digest_(digest), log_(log) {}

  void Add(const StepView& step) {
    step.ForEachMessage([this](const auto& message) { AddOne(message); });
  }

 private:
  template <class M>
  void AddOne(const M& message) {
    Encode(message, buffer_);
    digest_.Add(buffer_);
    if (log_ != nullptr) log_->Write(ChannelOf<M>().name, message.header.utime, buffer_);
  }

  Digest& digest_;
  EventLogWriter* log_;
  std::vector<std::uint8_t> buffer_;
};

void WriteScenarioParts(EventLogWriter& log, std::int64_t run_id, const std::string& text) {
  const std::vector<std::string> parts = SplitScenario(text);
  std::vector<std::uint8_t> buffer;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Encode(MakeRunPart(run_id, run_t::PREPARE, 0, HashOf(text), parts, i), buffer);
    log.Write(ChannelOf<run_t>().name, 0, buffer);
  }
}

ExperimentResult RunDirect(const Scenario& scenario, const ExperimentOptions& options) {
  const std::int64_t run_id = DrawRunId();
  std::optional<EventLogWriter> log;
  if (!options.log.empty()) {
    log.emplace(options.log);
    WriteScenarioParts(*log, run_id, PrintScenario(scenario));
  }
  ExperimentResult result;
  Digest digest;
  StepWriter writer(digest, log ? &*log : nullptr);
  MeasureAccumulator measures(scenario);
  FollowerAccumulator followers;
  result.samples.reserve(static_cast<std::size_t>(scenario.steps));
  const TimePoint began = Clock::now();
  ClosedLoop loop(scenario);
  loop.Run(run_id, [&](const StepView& step) {
    writer.Add(step);
    result.samples.push_back(step.ToSample());
    measures.Add(result.samples.back());
    followers.Add(step.truth, step.follower);
    if (WasInterrupted()) throw Interrupted("interrupted");
  });
  if (log) log->Flush();
  result.wall_s = std::chrono::duration<double>(Clock::now() - began).count();
  result.seed = scenario.seed;
  result.steps = static_cast<std::int64_t>(result.samples.size());
  result.digest = digest.Hex();
  result.measures = measures.Result();
  result.followers = followers.Result();
  result.log = options.log;
  return result;
}

ExperimentResult RunLogged(const Scenario& scenario, const ExperimentOptions& options) {
  std::optional<TemporaryDirectory> scratch;
  std::filesystem::path log = options.log;
  if (log.empty()) log = scratch.emplace().path() / "run.lcm";
  BusRun run = RunOnBus(scenario, options, log);
  LoggedRun logged = ReadLoggedRun(log);
  if (logged.run_id != run.run_id) {
    throw std::runtime_error(
        fmt::format("{}: the log is that of run {}, not of this one, {}: it was replaced meanwhile",
                    log.string(), logged.run_id, run.run_id));
  }
  if (!logged.complete) {
    throw std::runtime_error(
        fmt::format("{}: the log is not complete: {}", log.string(), logged.note));
  }
  ExperimentResult result = std::move(logged.result);
  result.wall_s = run.wall_s;
  result.repairs = run.repairs;
  result.refused = run.refused;
  result.send_troubles = std::move(run.send_troubles);
  result.strangers = run.strangers;
  result.restarts = std::move(run.restarts);
  result.log = options.log;
  return result;
}

}  // namespace

void CheckPossible(const Scenario& scenario, const std::filesystem::path& file) {
  try {
    const ClosedLoop parts(scenario);
  } catch (const InputError& error) {
    // "/pointer: message", or a message alone where no single field is to blame.
    const std::string what = error.what();
    const std::size_t colon = what.starts_with('/') ? what.find(": ") : std::string::npos;
    const bool field = colon != std::string::npos;
    throw ScenarioError(fmt::format("{}: error: {}", file.string(), what),
                        {{.file = file.string(),
                          .pointer = field ? what.substr(0, colon) : "",
                          .rule = "impossible",
                          .message = field ? what.substr(colon + 2) : what}});
  }
}

ExperimentResult RunExperiment(const Scenario& scenario, const ExperimentOptions& options) {
  ExperimentResult result =
      options.transport == "direct" ? RunDirect(scenario, options) : RunLogged(scenario, options);
  result.transport = options.transport;
  return result;
}

LoggedRun ReadLoggedRun(const std::filesystem::path& log) {
  LoggedRun logged;
  Digest digest;
  FollowerAccumulator followers;
  std::vector<Sample>& samples = logged.result.samples;
  SampleDecoder decoder;
  RunLogReader reader(log);
  while (const StepMessages* messages = reader.Next()) {
    for (const Bytes message : *messages) {
      if (!message.empty()) digest.Add(message);
    }
    const bool holes = std::ranges::any_of(kChannels, [&](const ChannelInfo& channel) {
      return channel.pace == Pace::kStep && (*messages)[PlaceOf(channel)].empty();
    });
    // Only a run in real time has holes; without TRUTH nobody can say how the step was.
    if (holes && (*messages)[IndexOf<truth_t>()].empty()) continue;
    const Sample* sample = holes ? decoder.DecodeWithHoles(*messages) : decoder.Decode(*messages);
    if (sample == nullptr) {
      throw InputError(
          fmt::format("{}: error: step {} does not decode: was it recorded with other "
                      "message types?",
                      log.string(), reader.run().steps - 1));
    }
    samples.push_back(*sample);
    followers.Add(decoder.truth(), decoder.follower());
  }
  const RunLog& run = reader.run();
  logged.run_id = run.run_id;
  logged.result.seed = run.scenario.seed;
  logged.result.steps = run.steps;
  logged.result.digest = digest.Hex();
  logged.result.log = log;
  logged.result.measures = Measure(samples, run.scenario);
  logged.result.followers = followers.Result();
  logged.scenario = run.scenario;
  logged.scenario_text = run.scenario_text;
  logged.result.realtime = run.realtime;
  logged.complete = run.complete;
  logged.note = run.note;
  return logged;
}

}  // namespace fogline
