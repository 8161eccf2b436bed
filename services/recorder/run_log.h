// A run as it stands in an event log: its scenario and its steps, one after another.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "scenario/scenario.h"
#include "services/recorder/event_log.h"

namespace fogline {

/// The messages of one step by place in kChannels; empty where there is none.
using StepMessages = std::array<Bytes, kNumChannels>;

/// What a log is, apart from its steps.
struct RunLog {
  std::int64_t run_id = 0;
  Scenario scenario;
  std::string scenario_text;
  std::string scenario_hash;
  std::int64_t steps = 0;  // complete ones, handed to the visitor
  bool complete = false;   // the last step says that it is the last, and none is missing
  std::string note;        // why it is not complete, or what was ignored; "" if nothing
};

/// Called with every complete step, in order, from 0. The bytes are valid during the call.
using StepVisitor = std::function<void(std::int64_t step, const StepMessages&)>;

/// Reads the run of a log that the recorder or lcm-logger wrote, in whatever order its events
/// stand, within bounded memory for logs in order.
/// @throws InputError when the file cannot be read, is no event log or has no scenario of a run
RunLog ReadRunLog(const std::filesystem::path& file, const StepVisitor& visit);

}  // namespace fogline
