// Valid messages and logs. The fuzz targets make their seeds from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "services/graph.h"
#include "services/log/event_log.h"
#include "services/runtime/wire/scenario_parts.h"
#include "tests/fuzz/fuzz.h"

namespace fogline::fuzz {

inline constexpr std::int64_t kRunId = 7;
/// The shortest text of a scenario with three steps.
inline constexpr std::string_view kScenarioText = R"({"version":1,"steps":3})";
inline constexpr std::int64_t kSteps = 3;

/// A valid message of a step. No list and no text in it is empty.
template <class M>
M Sample(std::int64_t step) {
  M message{};
  message.header = {.run_id = kRunId, .step = step, .utime = step * 100'000};
  if constexpr (requires { message.num_followers; }) {
    message.num_followers = 2;
    if constexpr (std::is_same_v<M, truth_t>) {
      message.last = step == kSteps - 1;
      for (auto* values : {&message.follower_position_m, &message.follower_speed_mps,
                           &message.follower_acceleration_mps2, &message.follower_gap_m}) {
        *values = {-40.5, -81};
      }
    } else {
      message.acceleration_mps2 = {0.25, -0.5};
      message.safe_distance_m = {38, 39};
    }
  } else if constexpr (std::is_same_v<M, status_t>) {
    message.role = "fusion";
    message.host = "lab2";
    message.state = status_t::RUNNING;
    message.sequence = 1 + step;
    message.scenario_hash = runtime::HashOf(kScenarioText);
    message.type_fingerprint = TypeFingerprint();
    message.waiting_for = "RADAR";
  } else if constexpr (std::is_same_v<M, driver_input_t>) {
    message.instance = 4711;
    message.sequence = step;
    message.latency_us = 17'000;
    message.device_kind = driver_input_t::GAMEPAD;
    message.device = "pad";
    message.present = 1;
    message.throttle = 0.25;
    message.axes = {0.25, -1};
    message.num_axes = 2;
    message.buttons = driver_input_t::TAKE_OVER;
  } else if constexpr (std::is_same_v<M, resend_t>) {
    message.channel = "TRUTH";
    message.count = 1;
    message.requester = "radar";
  } else if constexpr (std::is_same_v<M, run_t>) {
    message = runtime::MakeRunPart(kRunId, run_t::PREPARE, 0, runtime::HashOf(kScenarioText),
                                   {std::string(kScenarioText)}, 0);
  }
  return message;
}

template <class M>
Input Encoded(const M& message) {
  Input bytes;
  runtime::Encode(message, bytes);
  return bytes;
}

/// Calls `handle`.operator()<M>(i) for each type M of kGraph, where i is the index of the type's
/// channel in kChannels.
template <class Handle>
void ForEachType(const Handle& handle) {
  std::apply(
      [&](const auto&... each) {
        const auto call = [&]<class M>(std::type_identity<M>) {
          handle.template operator()<M>(IndexOf<M>());
        };
        (call(std::type_identity<typename std::decay_t<decltype(each)>::Message>()), ...);
      },
      kGraph);
}

/// A seed for each type: the index of its channel in kChannels, in one byte, and then a message.
inline std::vector<Input> SeedOfEachType() {
  std::vector<Input> seeds;
  ForEachType([&seeds]<class M>(std::size_t place) {
    Input& seed = seeds.emplace_back(Encoded(Sample<M>(1)));
    seed.insert(seed.begin(), static_cast<std::uint8_t>(place));
  });
  return seeds;
}

/// The RUN messages that carry a text in parts of `part_size` characters.
inline std::vector<run_t> RunParts(std::string_view text, std::size_t part_size) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < text.size(); at += part_size) {
    parts.emplace_back(text.substr(at, part_size));
  }
  std::vector<run_t> messages;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    messages.push_back(
        runtime::MakeRunPart(kRunId, run_t::PREPARE, 0, runtime::HashOf(text), parts, i));
  }
  return messages;
}

/// A log as the recorder writes it: the scenario, then the steps of the run.
inline Input SampleLog() {
  const MemoryFile file;
  {
    log::EventLogWriter log(file.path());
    for (const run_t& run : RunParts(kScenarioText, 10)) {
      log.Write(ChannelOf<run_t>().name, 0, Encoded(run));
    }
    for (std::int64_t step = 0; step < kSteps; ++step) {
      ForEachStepChannel([&]<class M>(std::size_t channel) {
        const M message = Sample<M>(step);
        log.Write(kChannels[channel].name, message.header.utime, Encoded(message));
      });
    }
  }
  return file.Content();
}

}  // namespace fogline::fuzz
