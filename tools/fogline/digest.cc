// fogline digest: the digest of a run from its log.
#include <memory>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "scenario/wording.h"
#include "services/recorder/run_log.h"
#include "services/runtime/diagnostics.h"
#include "services/runtime/digest.h"
#include "tools/fogline/arguments.h"
#include "tools/fogline/help.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct DigestArguments {
  std::vector<std::filesystem::path> logs;
  bool json = false;
};

int RunDigest(const DigestArguments& arguments) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  bool complete = true;
  const bool readable = ForEachReadable(arguments.logs, [&](const std::filesystem::path& log) {
    RunLogReader reader(log);
    Digest digest;
    while (const StepMessages* messages = reader.Next()) {
      for (const Bytes message : *messages) {
        if (!message.empty()) digest.Add(message);
      }
    }
    const RunLog& run = reader.run();
    complete = complete && run.complete;
    if (!run.note.empty()) Complain(fmt::format("{}: {}", PathText(log), run.note));
    rows.push_back({{"log", log.string()},
                    {"digest", digest.Hex()},
                    {"steps", run.steps},
                    {"complete", run.complete}});
    if (!arguments.json) fmt::print("{}  {}\n", digest.Hex(), PathText(log));
  });
  if (arguments.json) PrintJson(rows);
  if (!readable) return kBadInput;
  return complete ? kDone : kCheckFailed;
}

}  // namespace

void AddDigest(CLI::App& app, Action& action) {
  CLI::App* verb =
      app.add_subcommand("digest", "Print the digest of logs: equal digests, equal runs");
  const auto arguments = std::make_shared<DigestArguments>();
  verb->add_option("LOG", arguments->logs, "Event logs")->required();
  verb->add_flag("--json", arguments->json, "Print as JSON");
  ShowExitCodes(*verb, {.check_failed = "a log is not complete"});
  verb->footer("Example:\n  fogline digest logs/*.lcm");
  verb->callback([&action, arguments] { action = [arguments] { return RunDigest(*arguments); }; });
}

}  // namespace fogline
