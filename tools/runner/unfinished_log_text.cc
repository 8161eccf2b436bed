#include "tools/runner/unfinished_log_text.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/process/shell_word.h"
#include "common/text.h"
#include "services/log/log_guard.h"
#include "services/log/remains.h"
#include "services/runtime/transport/lcm_url.h"

namespace fogline::runner {
namespace {

/// Whether the log has steps of this run. If the run has ended before its first step, the file may
/// still be an older log of another run.
bool HasStepsOf(std::int64_t run_id, const std::filesystem::path& log) {
  try {
    return log::ReadFront(log).run_id == run_id && log::HasSteps(log);
  } catch (const InputError&) {
    return false;
  }
}

std::string InSeconds(Duration time) {
  return fmt::format("{:g}", std::chrono::duration<double>(time).count());
}

}  // namespace

std::string UnfinishedLogText(std::int64_t run_id, const RunOptions& options) {
  if (options.log.empty()) return "";
  if (!HasStepsOf(run_id, options.log)) return "no log was written";
  std::string text = fmt::format("the log so far: {}", PathText(options.log));
  if (!options.command_to_go_on.empty()) text += "\n  to go on: " + options.command_to_go_on;
  return text;
}

std::string CommandToGoOn(const RunOptions& options) {
  if (options.log.empty() || options.realtime) return "";
  const RunOptions unsaid;
  std::string command = "fogline run --resume " + ShellWord(options.log.string());
  if (runtime::IsLcmUrl(options.transport)) {
    command += " --lcm-url " + ShellWord(options.transport);
  } else if (options.transport != unsaid.transport || runtime::UrlOfEnvironment()) {
    command += " --transport " + options.transport;
  }
  for (const Role role : options.external) command += fmt::format(" --external {}", NameOf(role));
  if (options.pace != 0) command += fmt::format(" --pace {:g}", options.pace);
  if (options.stall_limit != unsaid.stall_limit) {
    command += " --stall-timeout " + InSeconds(options.stall_limit);
  }
  if (options.restarts != unsaid.restarts) {
    command += fmt::format(" --restarts {}", options.restarts);
  }
  if (options.wait != unsaid.wait) command += " --wait " + InSeconds(options.wait);
  if (options.same_build) command += " --same-build";
  if (options.verify) command += *options.verify ? " --verify" : " --no-verify";
  std::vector<std::string> words = options.hosts.words;
  std::ranges::copy(runtime::ToArguments(options.traffic), std::back_inserter(words));
  for (const std::string& word : words) command += " " + ShellWord(word);
  return command;
}

}  // namespace fogline::runner
