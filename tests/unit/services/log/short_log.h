// A log of a run of three steps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "fogline/fingerprint.hpp"
#include "fogline/log_graph_t.hpp"
#include "services/graph.h"
#include "services/log/about/log_graph.h"
#include "services/log/event_log.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/digest.h"
#include "services/runtime/wire/scenario_parts.h"

namespace fogline::test {

inline constexpr std::int64_t kRunId = 7;
inline constexpr std::int64_t kSteps = 3;
inline constexpr std::int64_t kStep_us = 100'000;
// The shortest scenario with kSteps steps.
inline constexpr std::string_view kScenario = R"({"version":1,"steps":3})";

struct ShortLog {
  bool realtime = false;
  /// Whether the log has the message of this channel and step. By default it has all messages.
  std::function<bool(std::string_view channel, std::int64_t step)> has =
      [](std::string_view, std::int64_t) { return true; };
  /// If set, the log ends with a STATUS of the world that has this step and the state DONE.
  std::optional<std::int64_t> done;
  /// Whether the log of a run in real time has a STATUS of the world.
  bool status = true;
  /// If set, the log ends with a STATUS of the radar that has computed this number of steps.
  std::optional<std::int64_t> radar_ticks;
  /// If set, the scenario has two parts, and a TRUTH of this step comes between them.
  std::optional<std::int64_t> early;
  /// If set, the log has this event on FOGLINE_GRAPH after the scenario.
  std::optional<log_graph_t> graph;
  std::int64_t type_fingerprint = TypeFingerprint();
};

/// Writes a log with these contents. @return the number of its bytes and events
inline log::LogHead WriteShortLog(const std::filesystem::path& file,
                                  const ShortLog& contents = {}) {
  log::EventLogWriter writer(file);
  std::vector<std::uint8_t> bytes;
  std::vector<std::string> parts = runtime::SplitScenario(std::string(kScenario));
  if (contents.early) {
    constexpr std::size_t kHalf = kScenario.size() / 2;
    parts = {std::string(kScenario.substr(0, kHalf)), std::string(kScenario.substr(kHalf))};
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i == 1 && contents.early) {
      truth_t truth{};
      truth.header = {.run_id = kRunId, .step = *contents.early, .utime = 0};
      runtime::Encode(truth, bytes);
      writer.Write(ChannelOf<truth_t>().name, 0, bytes);
    }
    run_t run =
        runtime::MakeRunPart(kRunId, run_t::PREPARE, 0, runtime::HashOf(kScenario), parts, i);
    if (contents.realtime) {
      run.realtime = 1;
      run.pace = 1;
    }
    run.type_fingerprint = contents.type_fingerprint;
    runtime::Encode(run, bytes);
    writer.Write(ChannelOf<run_t>().name, 0, bytes);
  }
  if (contents.graph) {
    runtime::Encode(*contents.graph, bytes);
    writer.Write(log::kLogGraphChannel, 0, bytes);
  }
  for (std::int64_t step = 0; step < kSteps; ++step) {
    ForEachStepChannel([&]<class M>(std::size_t) {
      if (!contents.has(ChannelOf<M>().name, step)) return;
      M message{};
      message.header = {.run_id = kRunId, .step = step, .utime = step * kStep_us};
      if constexpr (std::is_same_v<M, truth_t>) message.last = step == kSteps - 1;
      runtime::Encode(message, bytes);
      writer.Write(ChannelOf<M>().name, message.header.utime, bytes);
    });
  }
  if (contents.done || (contents.realtime && contents.status)) {
    const std::int64_t step = contents.done.value_or(kSteps - 1);
    status_t status{};
    status.header = {.run_id = kRunId, .step = step, .utime = step * kStep_us};
    status.role = NameOf(Role::kWorld);
    status.sequence = 1;
    status.state = contents.done ? status_t::DONE : status_t::RUNNING;
    runtime::Encode(status, bytes);
    writer.Write(ChannelOf<status_t>().name, status.header.utime, bytes);
  }
  if (contents.radar_ticks) {
    status_t status{};
    status.header = {.run_id = kRunId, .step = kSteps - 1, .utime = (kSteps - 1) * kStep_us};
    status.role = NameOf(Role::kRadar);
    status.sequence = 1;
    status.state = status_t::RUNNING;
    status.ticks = *contents.radar_ticks;
    runtime::Encode(status, bytes);
    writer.Write(ChannelOf<status_t>().name, status.header.utime, bytes);
  }
  writer.Flush();
  return writer.head();
}

/// Writes a log. @return its run
inline log::RunLog RunOf(const std::filesystem::path& file, const ShortLog& contents) {
  WriteShortLog(file, contents);
  log::RunLogReader reader(file);
  while (reader.Next() != nullptr) {
  }
  return reader.run();
}

}  // namespace fogline::test
