#include "tools/fogline/direct_log.h"

#include <algorithm>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "services/runtime/scenario_parts.h"

namespace fogline {

DirectLog::DirectLog(const ExperimentOptions& options, std::int64_t run_id,
                     const std::string& scenario_text)
    : file_(options.log) {
  if (options.resume) {
    remains_ = options.resume->remains;
    old_.emplace(file_);
    old_->GoTo(options.resume->front.head);
    return;
  }
  log_.emplace(file_);
  const std::vector<std::string> parts = SplitScenario(scenario_text);
  std::vector<std::uint8_t> buffer;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Encode(MakeRunPart(run_id, run_t::PREPARE, 0, HashOf(scenario_text), parts, i), buffer);
    log_->Write(ChannelOf<run_t>().name, 0, buffer);
  }
}

void DirectLog::Add(std::int64_t step, const ChannelInfo& channel, std::int64_t utime,
                    Bytes message) {
  if (step < remains_.steps) return Compare(step, channel, message);
  if (!log_) {
    old_.reset();
    log_.emplace(file_, remains_.head);
  }
  log_->Write(channel.name, utime, message);
}

void DirectLog::Compare(std::int64_t step, const ChannelInfo& channel, Bytes message) {
  const auto event = old_->Next();
  if (event && event->channel == channel.name && std::ranges::equal(event->data, message)) return;
  throw InputError(
      fmt::format("{}: error: --resume: step {}: {} is not what {} computes here: the log was made "
                  "by another program, or another version",
                  file_.string(), step, channel.name, NameOf(channel.from)));
}

void DirectLog::Flush() {
  if (log_) log_->Flush();
}

}  // namespace fogline
