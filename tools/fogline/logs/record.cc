// fogline record: writes the traffic of an LCM network into an event log.
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "services/log/event_log.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"
#include "tools/record/recording.h"

namespace fogline {
namespace {

constexpr const char* kRecordExplanation =
    R"(Writes every message on the network as lcm-logger does, but its queue has no limit. So a slow disk
loses no message. A message is lost only if the socket's buffer overflows (--recv-buffer-mb).
Ctrl-C ends the recording with a whole log and a summary. The summary counts, for each sender, the
messages that are missing, by LCM's own numbers (udpm only). With a rotation the files are
LOG-000.lcm, LOG-001.lcm and so on. If one of these files exists, the recording does not begin
without --force. With --force it first removes all of them, so that no file of an earlier
recording is left. Without --lcm-url it also records the newest run that is announced on this
machine. A full disk ends the recording (exit code 3); the log then ends with a whole message.

Examples:
  fogline record logs/all.lcm
  fogline record logs/run.lcm --lcm-url 'udpm://239.255.76.67:7700?ttl=0'
  fogline record logs/sensors.lcm --channels 'RADAR|LIDAR' --for 60 --json
  fogline record logs/day.lcm --rotate-s 3600
  lcm-logplayer logs/all.lcm                       plays what was recorded)";

constexpr double kMegabyte = 1e6;

struct RecordArguments {
  explicit RecordArguments(CLI::App& verb) : network(verb, "to record") {
    verb.add_option("LOG", log, "Event log to write")->required();
    verb.add_option("--channels", channels,
                    "Record only channels whose whole name matches this regular expression");
    verb.add_option("--recv-buffer-mb", buffer_mb, "Receive buffer of the socket, in MB")
        ->check(cli::NumberIn(0.01, 2000))
        ->capture_default_str();
    verb.add_option("--flush-ms", flush_ms,
                    "Longest time until a message is handed to the operating system, in ms")
        ->check(cli::NumberIn(0, 1e6))
        ->capture_default_str();
    verb.add_option("--rotate-mb", rotate_mb, "Begin a new file at this size, in MB (0: never)")
        ->check(cli::NumberIn(0, 1e9))
        ->capture_default_str();
    verb.add_option("--rotate-s", rotate_s, "Begin a new file after this time, in s (0: never)")
        ->check(cli::NumberIn(0, 1e9))
        ->capture_default_str();
    verb.add_option("--for", limit_s, "End after this time, in s (0: never)")
        ->check(cli::NumberIn(0, 1e9))
        ->capture_default_str();
    verb.add_flag("--force", force, "Replace an existing log, with a rotation all its files");
    verb.add_flag("--json", json, "Print the summary as JSON");
    cli::ShowExitCodes(verb);
    verb.footer(kRecordExplanation);
  }

  cli::NetworkArguments network;
  std::filesystem::path log;
  std::string channels;
  double buffer_mb = 8;
  double flush_ms = 100;
  double rotate_mb = 0;
  double rotate_s = 0;
  double limit_s = 0;
  bool force = false;
  bool json = false;
};

/// @throws InputError
std::regex RegexOf(const std::string& channels) {
  try {
    return std::regex(channels, std::regex::ECMAScript | std::regex::optimize);
  } catch (const std::regex_error& error) {
    throw InputError(fmt::format("error: --channels {}: no regular expression: {}", Shown(channels),
                                 error.what()));
  }
}

record::RecordingOptions OptionsOf(const RecordArguments& arguments) {
  record::RecordingOptions options;
  options.url = arguments.network.Url();
  options.follows = arguments.network.Follows();
  options.file = arguments.log;
  if (!arguments.channels.empty()) options.channels = RegexOf(arguments.channels);
  options.buffer_bytes = static_cast<int>(arguments.buffer_mb * kMegabyte);
  options.flush_every = cli::FromSeconds(arguments.flush_ms / 1e3);
  options.rotation = {.most_bytes = static_cast<std::int64_t>(arguments.rotate_mb * kMegabyte),
                      .longest = cli::FromSeconds(arguments.rotate_s)};
  options.limit = cli::FromSeconds(arguments.limit_s);
  options.say = [](const std::string& line) { Notice(line); };
  return options;
}

int RunRecord(const RecordArguments& arguments) {
  const record::RecordingOptions options = OptionsOf(arguments);
  RequireFolderOf(arguments.log, "LOG");
  const std::vector<std::filesystem::path> replaced =
      options.rotation.Any() ? record::LogFiles::InTheWay(arguments.log)
                             : std::vector{arguments.log};
  if (!IsReplaceable(arguments.log)) {
    throw InputError(fmt::format(
        "{}: error: LOG: this path names a pipe, a device or an open file of this process; name a "
        "file to write",
        PathText(arguments.log)));
  }
  for (const std::filesystem::path& file : replaced) {
    RefuseToReplace(file, "LOG", arguments.force, "event log", log::IsEventLogOrEmpty);
  }
  WatchInterrupts();
  record::Recording recording(options);
  recording.Run();
  if (arguments.json) {
    cli::PrintJson(recording.Json());
  } else {
    fmt::print("{}", recording.Text());
  }
  if (!recording.error().empty()) throw std::runtime_error(recording.error());
  return kDone;
}

}  // namespace

void AddRecord(CLI::App& app, cli::Action& action) {
  CLI::App* verb =
      app.add_subcommand("record", "Record the traffic of an LCM network, of any programs");
  const auto arguments = std::make_shared<RecordArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return RunRecord(*arguments); }; });
}

}  // namespace fogline
