// fogline digest: prints the digest of a run from its log.
#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/process/console.h"
#include "common/text.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/build_id.h"
#include "services/runtime/wire/message_signer.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/log_reading.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct DigestArguments {
  std::vector<std::filesystem::path> logs;
  std::string key;
  std::optional<std::int64_t> run_id;
  bool json = false;
};

struct Signature {
  std::string_view state;
  std::string trouble;  // "" if there is none
};

/// @param key the key with which the log must be signed; nullptr: the signature is not checked
Signature SignatureOf(const log::RunLog& run, const runtime::SigningKey* key) {
  const bool is_signed = run.seal && runtime::LooksSigned(run.seal->event);
  if (key == nullptr) return {is_signed ? "not checked" : "none", ""};
  if (!run.seal) return {"none", "not sealed, so nothing is signed"};
  switch (log::VerifySeal(*run.seal, *key)) {
    case log::SealSignature::kHolds:
      return {"holds", ""};
    case log::SealSignature::kNone:
      return {"none", "not signed"};
    case log::SealSignature::kWrong:
      break;
  }
  return {"wrong", "signed with another key, or altered later"};
}

/// The builds of the roles, such as {"world": "0123456789abcdef", ...}; null for a role that has
/// not reported its build. The result is null if the log has no complete seal.
nlohmann::ordered_json BuildsJson(const log::RunLog& run) {
  if (!run.seal || !run.seal->whole) return nullptr;
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  const log_seal_t& says = run.seal->says;
  for (const RoleInfo& info : kRoles) {
    const auto place = std::ranges::find(says.role, info.name) - says.role.begin();
    const runtime::BuildId build = place < std::ssize(says.build_id)
                                       ? says.build_id[static_cast<std::size_t>(place)]
                                       : runtime::kUnknownBuild;
    json[std::string(info.name)] = cli::BuildJson(build);
  }
  return json;
}

/// State of a log's seal: "none", "holds", "copy", or "broken" if the log was altered. A copy is a
/// log that was played and recorded again: its events have other times, and STATUS messages may be
/// missing. So the seal covers only the scenario and the steps of a copy.
std::string_view SealState(const log::RunLog& run) {
  if (!run.seal) return "none";
  if (run.altered) return "broken";
  return run.seal->copied ? "copy" : "holds";
}

/// Whether the log is a copy of the log of a run in real time. The results of such a run are in
/// STATUS messages, but the seal of a copy does not cover STATUS messages. So the seal of a copy
/// does not prove the results.
bool IsUnprovenCopy(const log::RunLog& run) { return run.realtime && SealState(run) == "copy"; }

int RunDigest(const DigestArguments& arguments) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  bool sound = true;
  std::optional<runtime::SigningKey> key;
  if (!arguments.key.empty()) key = runtime::SigningKey::Load(arguments.key);
  const bool readable = cli::ForEachReadable(arguments.logs, [&](const std::filesystem::path& log) {
    log::RunLogReader reader(
        log, {.compared = log::ReadOptions::Compared::kFile, .run_id = arguments.run_id});
    while (reader.Next() != nullptr) {
    }
    const log::RunLog& run = reader.run();
    const Signature signature = SignatureOf(run, key ? &*key : nullptr);
    sound = sound && run.complete;
    if (key) sound = sound && signature.state == "holds" && !IsUnprovenCopy(run);
    cli::SayAboutLog(log, run);
    if (!signature.trouble.empty()) {
      Complain(fmt::format("{}: {}", PathText(log), signature.trouble));
    }
    if (key && IsUnprovenCopy(run)) {
      Complain(PathText(log) + ": a copy of a run in real time; its seal proves only the steps");
    }
    rows.push_back({{"log", log.string()},
                    {"digest", cli::DigestJson(run)},
                    {"steps", run.steps},
                    {"complete", run.complete},
                    {"seal", SealState(run)},
                    {"signature", signature.state},
                    {"builds", BuildsJson(run)}});
    if (!arguments.json) fmt::print("{}  {}\n", log::DigestText(run), PathText(log));
  });
  if (arguments.json) cli::PrintJson(rows);
  if (!readable) return kBadInput;
  return sound ? kDone : kCheckFailed;
}

}  // namespace

void AddDigest(CLI::App& app, cli::Action& action) {
  CLI::App* verb =
      app.add_subcommand("digest", "Print the digest of logs; equal runs have equal digests");
  const auto arguments = std::make_shared<DigestArguments>();
  verb->add_option("LOG", arguments->logs, "Event logs")->required();
  verb->add_option("--key", arguments->key,
                   "Require that each log is signed with the key in this file");
  cli::AddRunOption(*verb, arguments->run_id);
  verb->add_flag("--json", arguments->json, "Print as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "a log is not whole or not signed"});
  verb->footer(
      "A run ends its log with a seal (channel FOGLINE_SEAL): its digest, a hash of the file,\n"
      "and the build of each role. With --key the run signs the seal. This verb reports a later\n"
      "change of the log. The log of a killed run has no seal. If lcm-logplayer has played a\n"
      "log and lcm-logger has recorded it, the seal covers only scenario and steps\n"
      "(\"seal\": \"copy\"). The digest of a log that lacks messages is that of the complete\n"
      "steps before the first gap; it is unknown (null) if there is no such step.\n\n"
      "Examples:\n"
      "  fogline digest logs/*.lcm\n"
      "  fogline run scenario/paper.json --key lab.key --log logs/signed.lcm\n"
      "  fogline digest logs/signed.lcm --key lab.key");
  verb->callback([&action, arguments] { action = [arguments] { return RunDigest(*arguments); }; });
}

}  // namespace fogline
