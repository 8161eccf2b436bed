// The reader of runs in event logs. Input: the file.
#include <algorithm>
#include <array>

#include "common/errors.h"
#include "services/log/about/log_graph.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

// For a log in real time, the reader returns all steps of the scenario, although most of these
// steps may have no message. This target reads at most this many steps, so that their contents fit
// into memory.
constexpr std::size_t kMostSteps = 100'000;
struct TooManySteps {};

/// The contents of a log.
struct Reading {
  std::vector<std::array<Input, kNumChannels>> steps;
  bool refused = false;
  log::RunLog run;
};

/// Reads the steps of a log. @throws TooManySteps
Reading Read(const std::filesystem::path& file) {
  Reading reading;
  log::RunLogReader reader(file);
  try {
    while (const log::StepMessages* messages = reader.Next()) {
      if (reading.steps.size() == kMostSteps) throw TooManySteps();
      auto& step = reading.steps.emplace_back();
      for (std::size_t i = 0; i < kNumChannels; ++i) {
        step[i].assign((*messages)[i].begin(), (*messages)[i].end());
      }
    }
  } catch (const InputError&) {
    reading.refused = true;
  }
  Demand(reader.Next() == nullptr, "after the end nothing follows");
  reading.run = reader.run();
  return reading;
}

void DemandWholeSteps(const Reading& reading) {
  for (std::size_t step = 0; step < reading.steps.size(); ++step) {
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      const Input& message = reading.steps[step][i];
      const bool expected = reading.run.channels[i];
      // A run in real time continues if a message is missing.
      const bool hole = expected && message.empty() && reading.run.realtime;
      Demand(hole || message.empty() != expected, "a step has a message of each of its channels");
      if (message.empty()) continue;
      Demand(runtime::ReadInt64(message, runtime::kRunIdOffset) == reading.run.run_id,
             "all is of one run");
      Demand(runtime::ReadInt64(message, runtime::kStepOffset) == static_cast<std::int64_t>(step),
             "steps come once each, in order");
    }
  }
  Demand(reading.run.steps == static_cast<std::int64_t>(reading.steps.size()),
         "all steps are counted");
}

/// Writes the run as the recorder would have written it.
void Rewrite(const Reading& reading, const std::filesystem::path& file) {
  log::EventLogWriter log(file);
  const std::vector<std::string> parts = runtime::SplitScenario(reading.run.scenario_text);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const run_t run = runtime::MakeRunPart(reading.run.run_id, run_t::PREPARE, 0,
                                           reading.run.scenario_hash, parts, i);
    log.Write(ChannelOf<run_t>().name, 0, Encoded(run));
  }
  log::WriteLogGraph(log, reading.run.run_id, reading.run.channels);
  for (const auto& step : reading.steps) {
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      if (!step[i].empty()) log.Write(kChannels[i].name, 0, step[i]);
    }
  }
}

void DemandRunOrRefusal(runtime::Bytes bytes) {
  const MemoryFile file(bytes);
  try {
    const Reading reading = Read(file.path());
    DemandWholeSteps(reading);
    Demand(!reading.run.altered || (reading.run.seal && !reading.run.complete),
           "a log that differs from its seal is not complete");
    if (reading.refused || reading.run.realtime) return;  // the copy would be a lockstep run
    const MemoryFile copy;
    Rewrite(reading, copy.path());
    const Reading again = Read(copy.path());
    Demand(again.steps == reading.steps, "a copy has the same steps");
    Demand(again.run.scenario_text == reading.run.scenario_text, "a copy has the same scenario");
    Demand(again.run.complete || !reading.run.complete, "a copy of a complete run is complete");
    Demand(Printable(reading.run.note), "the note about a log can be printed");
    if (!reading.steps.empty()) Took();
  } catch (const InputError&) {
    return;  // not an event log
  } catch (const TooManySteps&) {
    return;
  }
}

/// Adds a log graph to a log. This graph says that each step of the log has messages on exactly
/// these channels.
Input WithLogGraph(const Input& log, const runtime::ChannelSet& channels) {
  const MemoryFile from(log);
  const MemoryFile to;
  {
    log::EventLogReader reader(from.path());
    log::EventLogWriter writer(to.path());
    bool has_graph = false;
    while (const auto event = reader.Next()) {
      if (event->channel != ChannelOf<run_t>().name && !has_graph) {
        log::WriteLogGraph(writer, kRunId, channels);
        has_graph = true;
      }
      writer.Write(event->channel, event->utime, event->data);
    }
  }
  return to.Content();
}

/// Adds the seal that a run leaves in its log.
Input WithLogSeal(const Input& log) {
  const MemoryFile file(log);
  const Reading reading = Read(file.path());
  log_seal_t seal{};
  seal.header = {.run_id = kRunId, .step = kSteps - 1, .utime = (kSteps - 1) * 100'000};
  seal.digest = reading.run.digest;
  seal.steps = reading.run.steps;
  seal.complete = 1;
  seal.scenario_hash = reading.run.scenario_hash;
  seal.file_hash = runtime::HashOf({reinterpret_cast<const char*>(log.data()), log.size()});
  seal.role = {"world"};
  seal.build_id = {4711};
  seal.num_roles = 1;
  log::SealLog(file.path(), reading.run.events, seal, nullptr);
  return file.Content();
}

}  // namespace

std::vector<Input> Seeds() {
  const Input log = SampleLog();
  const Input torn(log.begin(), log.end() - 9);
  const MemoryFile file(log);
  log::EventLogReader reader(file.path());
  std::vector<log::Event> events;
  while (const auto event = reader.Next()) events.push_back(*event);

  // A log of signed traffic, as lcm-logger writes it.
  const MemoryFile signed_log;
  runtime::MessageSigner signer(runtime::SigningKey({}), {});
  {
    log::EventLogWriter writer(signed_log.path());
    for (const log::Event& event : events) {
      writer.Write(event.channel, event.utime, signer.Sign(event.channel, event.data));
    }
  }
  // The events in reverse order, but all RUN messages (the scenario's parts) come first.
  const auto steps = std::ranges::find_if(
      events, [](const log::Event& event) { return event.channel != ChannelOf<run_t>().name; });
  std::reverse(steps, events.end());
  std::reverse(events.begin(), steps);
  const MemoryFile reversed;
  {
    log::EventLogWriter writer(reversed.path());
    for (const log::Event& event : events) writer.Write(event.channel, event.utime, event.data);
  }
  runtime::ChannelSet without_radar = log::OwnStepChannels();
  without_radar.reset(IndexOf<radar_t>());
  return {log,
          torn,
          signed_log.Content(),
          reversed.Content(),
          WithLogSeal(log),
          WithLogSeal(WithLogGraph(log, log::OwnStepChannels())),
          WithLogGraph(log, without_radar)};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandRunOrRefusal({data, size});
  return 0;
}
