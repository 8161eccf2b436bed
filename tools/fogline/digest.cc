// fogline digest: the digest of a run from its log.
#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "scenario/wording.h"
#include "services/recorder/run_log.h"
#include "services/runtime/build_id.h"
#include "services/runtime/diagnostics.h"
#include "services/runtime/seal.h"
#include "tools/fogline/arguments.h"
#include "tools/fogline/help.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct DigestArguments {
  std::vector<std::filesystem::path> logs;
  std::string key;
  bool json = false;
};

struct Signature {
  std::string_view state;
  std::string trouble;  // "" if there is none
};

/// @param key with which a log must be signed; nullptr: any key or none
Signature SignatureOf(const RunLog& run, const SealKey* key) {
  const bool is_signed = run.seal && LooksSealed(run.seal->event);
  if (key == nullptr) return {is_signed ? "not checked" : "none", ""};
  if (!run.seal) return {"none", "not sealed, so nothing is signed"};
  switch (VerifySeal(*run.seal, *key)) {
    case SealSignature::kHolds:
      return {"holds", ""};
    case SealSignature::kNone:
      return {"none", "not signed"};
    case SealSignature::kWrong:
      break;
  }
  return {"wrong", "signed with another key, or altered since"};
}

/// {"world": "0123456789abcdef", ...}, with null for a role that has not reported its build. The
/// result is null without a seal.
nlohmann::ordered_json BuildsJson(const RunLog& run) {
  if (!run.seal || !run.seal->whole) return nullptr;
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  const log_seal_t& says = run.seal->says;
  for (const RoleInfo& info : kRoles) {
    const auto place = std::ranges::find(says.role, info.name) - says.role.begin();
    const BuildId build = place < std::ssize(says.build_id)
                              ? says.build_id[static_cast<std::size_t>(place)]
                              : kUnknownBuild;
    json[std::string(info.name)] = BuildJson(build);
  }
  return json;
}

int RunDigest(const DigestArguments& arguments) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  bool sound = true;
  std::optional<SealKey> key;
  if (!arguments.key.empty()) key = SealKey::Load(arguments.key);
  const bool readable = ForEachReadable(arguments.logs, [&](const std::filesystem::path& log) {
    RunLogReader reader(log, RunLogReader::Compared::kFile);
    while (reader.Next() != nullptr) {
    }
    const RunLog& run = reader.run();
    const Signature signature = SignatureOf(run, key ? &*key : nullptr);
    sound = sound && run.complete && (!key || signature.state == "holds");
    if (!run.note.empty()) Complain(fmt::format("{}: {}", PathText(log), run.note));
    if (!signature.trouble.empty()) {
      Complain(fmt::format("{}: {}", PathText(log), signature.trouble));
    }
    rows.push_back({{"log", log.string()},
                    {"digest", run.digest},
                    {"steps", run.steps},
                    {"complete", run.complete},
                    {"seal", !run.seal     ? "none"
                             : run.altered ? "broken"
                                           : "holds"},
                    {"signature", signature.state},
                    {"builds", BuildsJson(run)}});
    if (!arguments.json) fmt::print("{}  {}\n", run.digest, PathText(log));
  });
  if (arguments.json) PrintJson(rows);
  if (!readable) return kBadInput;
  return sound ? kDone : kCheckFailed;
}

}  // namespace

void AddDigest(CLI::App& app, Action& action) {
  CLI::App* verb =
      app.add_subcommand("digest", "Print the digest of logs: equal digests, equal runs");
  const auto arguments = std::make_shared<DigestArguments>();
  verb->add_option("LOG", arguments->logs, "Event logs")->required();
  verb->add_option("--key", arguments->key,
                   "Demand that each log was signed with the key in this file");
  verb->add_flag("--json", arguments->json, "Print as JSON");
  ShowExitCodes(*verb, {.check_failed = "a log is not whole or not signed"});
  verb->footer(
      "A run ends its log with a seal (channel FOGLINE_SEAL): its digest, a hash of the file, and\n"
      "the build of each role; with --key the run signs it. What was altered since then is named.\n"
      "A log of lcm-logger, or of a run that was killed, has none.\n\n"
      "Examples:\n  fogline digest logs/*.lcm\n"
      "  fogline run scenario/paper.json --key lab.key --log logs/signed.lcm\n"
      "  fogline digest logs/signed.lcm --key lab.key");
  verb->callback([&action, arguments] { action = [arguments] { return RunDigest(*arguments); }; });
}

}  // namespace fogline
