#include "tools/runner/direct_log.h"

#include <algorithm>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/loader.h"
#include "services/log/about/log_graph.h"
#include "services/runtime/transport/traffic_options.h"
#include "services/runtime/wire/build_id.h"
#include "services/runtime/wire/scenario_parts.h"

namespace fogline::runner {

DirectLog::DirectLog(const RunOptions& options, std::int64_t run_id, const Scenario& scenario)
    : file_(options.log), key_(runtime::KeyOf(options.traffic)) {
  run_.run_id = run_id;
  run_.scenario = scenario;
  builds_.fill(runtime::OwnBuildId());
  if (options.resume && options.resume->front.wall_clock) {
    throw InputError(fmt::format(
        "{}: error: --resume: the log has the wall clock of each step, which a run with "
        "--transport direct has not",
        PathText(file_)));
  }
  if (options.resume) {
    run_.scenario_hash = options.resume->front.parts.hash();
    remains_ = options.resume->remains;
    old_.emplace(file_);
    old_->GoTo(options.resume->front.head);
  } else {
    log_.emplace(file_);
    WriteScenario(PrintScenario(scenario));
  }
  sealer_.emplace(file_);
}

void DirectLog::WriteScenario(const std::string& text) {
  run_.scenario_hash = runtime::HashOf(text);
  const std::vector<std::string> parts = runtime::SplitScenario(text);
  std::vector<std::uint8_t> buffer;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    runtime::Encode(
        runtime::MakeRunPart(run_.run_id, run_t::PREPARE, 0, run_.scenario_hash, parts, i), buffer);
    log_->Write(ChannelOf<run_t>().name, 0, buffer);
  }
  log::WriteLogGraph(*log_, run_.run_id);
}

void DirectLog::Add(std::int64_t step, const ChannelInfo& channel, std::int64_t utime,
                    runtime::Bytes message) {
  if (step < remains_.steps) return Compare(step, channel, message);
  if (!log_) {
    old_.reset();
    log_.emplace(file_, remains_.head);
  }
  log_->Write(channel.name, utime, message);
}

void DirectLog::Compare(std::int64_t step, const ChannelInfo& channel, runtime::Bytes message) {
  const auto event = old_->Next();
  if (event && event->channel == channel.name && std::ranges::equal(event->data, message)) return;
  throw InputError(
      fmt::format("{}: error: --resume: step {}: {} differs from what {} computes here: the log "
                  "was made by another program, or another version",
                  PathText(file_), step, channel.name, NameOf(channel.from)));
}

void DirectLog::Flush() {
  if (log_) log_->Flush();
}

void DirectLog::End(const RunResult& result) {
  if (!log_) return;  // the log already has all messages
  run_.steps = result.steps;
  run_.digest = result.digest;
  run_.ended = true;
  run_.complete = true;
  run_.events = log_->head();
  sealer_->Seal(run_, {log_->written()}, {.builds = builds_}, key());
}

void DirectLog::CutOff() {
  if (!log_) return;
  log_->Flush();
  sealer_->SealCutOff({log_->written()}, {.builds = builds_}, key());
}

}  // namespace fogline::runner
