#include "tools/runner/resumed_log.h"

#include <string>
#include <string_view>

#include <fmt/core.h>

#include "common/process/console.h"
#include "common/text.h"
#include "scenario/io/loader.h"
#include "services/log/about/log_version.h"
#include "services/log/log_guard.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/message_signer.h"
#include "services/runtime/wire/wire.h"

namespace fogline::runner {
namespace {

// When a runner is killed, the kernel also kills the runner's roles. This takes a moment, in which
// the run's recorder still has the lock of the log.
constexpr Duration kEndOfOthers = milliseconds(2000);

[[noreturn]] void Refuse(const std::filesystem::path& log, std::string_view why) {
  throw InputError(fmt::format("{}: error: --resume: {}", PathText(log), why));
}

/// Restores an older log that the killed run was to replace. Checks that the file exists and is an
/// event log.
/// @return the path of the log @throws InputError
const std::filesystem::path& Readable(const std::filesystem::path& log) {
  const std::string older = log::TakeBackOlder(log, "--resume", kEndOfOthers);
  if (!older.empty()) Complain(older);
  log::ReadFront(log);
  return log;
}

/// Refuses a log that was changed since it was sealed, because a new seal would hide the change.
void CheckSeal(const std::filesystem::path& log, const runtime::SigningKey* key) {
  log::RunLogReader reader(log, log::RunLogReader::Compared::kFile);
  while (reader.Next() != nullptr) {
  }
  const log::RunLog& run = reader.run();
  if (run.altered) Refuse(log, "the log is not the one that was sealed: " + run.note);
  if (!run.seal) return;
  if (key == nullptr) {
    if (!runtime::LooksSigned(run.seal->event)) return;
    Refuse(log, "the seal of the log is signed, and --key does not name its key");
  }
  if (log::VerifySeal(*run.seal, *key) == log::SealSignature::kHolds) return;
  Refuse(log, "the seal of the log is not signed with this key");
}

/// Refuses a log with other message types. @throws InputError that names the version of the writer
void CheckVersion(const std::filesystem::path& log) {
  const log::LogVersion version = log::VersionOf(log);
  if (!version.other_types) return;
  const std::string writer = version.writer.empty() ? "another version of Fogline" : version.writer;
  Refuse(log, "the log was made with other message types, by " + writer);
}

Resumption Read(const std::filesystem::path& log, const runtime::SigningKey* key) {
  log::LogFront front = log::ReadFront(log);
  if (!front.parts.Complete() || front.type_fingerprint != TypeFingerprint()) CheckVersion(log);
  if (!front.parts.Complete()) {
    Refuse(log, "the log does not begin with the scenario of a run: start a new run");
  }
  if (!front.parts.HashHolds()) Refuse(log, "the scenario in the log does not match its hash");
  if (front.realtime) {
    Refuse(log, "a run in real time cannot be resumed; only runs in lockstep can");
  }
  CheckSeal(log, key);
  const log::Remains remains = log::ReadRemains(log, front);
  if (!remains.final) {
    if (const std::string odd = log::OddEnd(log, front, remains); !odd.empty()) {
      Refuse(log, odd + ": fogline run does not leave a log like this");
    }
  }
  return {.front = std::move(front), .remains = remains};
}

}  // namespace

ResumedLog::ResumedLog(const std::filesystem::path& log, const runtime::SigningKey* key)
    : lock_(Readable(log), FileLock::Kind::kOwn, "--resume", "run", kEndOfOthers),
      resumption_(Read(log, key)),
      scenario_(ParseScenario(resumption_.front.parts.Text(), log.string())) {
  CheckPossible(scenario_, log);
}

}  // namespace fogline::runner
