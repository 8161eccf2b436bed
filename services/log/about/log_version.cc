#include "services/log/about/log_version.h"

#include <array>
#include <cstdint>
#include <string_view>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "scenario/io/loader.h"
#include "services/log/log_seal.h"
#include "services/runtime/process/version.h"
#include "services/runtime/wire/message_signer.h"

namespace fogline::log {
namespace {

/// A released version, with the fingerprint of its run_t, and the fingerprint of all its message
/// types. A log begins with a run_t message, which contains the second fingerprint.
struct Release {
  std::string_view version;
  std::uint64_t run_type;
  std::uint64_t types;
};

// Each release adds a row. tests/integration/logs/kept has a log of each row.
constexpr std::array kReleases{
    Release{"0.1.0 (early state)", 0x070863bf726b2767, 0xb85592370e33d6d8},
    Release{"0.1.0", 0x2882f3444cf3aa2b, 0x4c80df75548ff58f},
};

std::string Named(std::string_view version) { return fmt::format("Fogline {}", version); }

/// The first release for which `has` is true; "" if there is no such release.
template <class Has>
std::string FindRelease(const Has& has) {
  for (const Release& release : kReleases) {
    if (has(release)) return Named(release.version);
  }
  return "";
}

/// Takes the version from a message on RUN.
void TakeRun(runtime::Bytes data, LogVersion& version) {
  if (data.size() < runtime::kHeaderEnd) return;
  const auto type = static_cast<std::uint64_t>(runtime::ReadInt64(data, 0));
  run_t run{};
  const bool decodes =
      runtime::Decode(data, run) ||
      (runtime::LooksSigned(data) && runtime::Decode(runtime::WithoutSignature(data), run));
  if (decodes) {
    version.other_types = run.type_fingerprint != TypeFingerprint();
    version.writer = FindRelease([&run](const Release& release) {
      return release.types == static_cast<std::uint64_t>(run.type_fingerprint);
    });
  } else if (type != static_cast<std::uint64_t>(run_t::getHash())) {
    version.other_types = true;
    version.writer =
        FindRelease([type](const Release& release) { return release.run_type == type; });
  }
}

}  // namespace

std::string LogVersion::Text() const {
  const std::string here = Named(runtime::Version());
  if (!other_types && (writer.empty() || writer == here)) return "";
  return fmt::format("written by {}{}; this is {}",
                     writer.empty() ? "another version of Fogline" : writer,
                     other_types ? " with other message types" : "", here);
}

LogVersion VersionOf(const std::filesystem::path& log) {
  LogVersion version;
  EventLogReader reader(log);
  bool begun = false;
  while (const auto event = reader.Next()) {
    if (event->channel == ChannelOf<run_t>().name && !begun) {
      TakeRun(event->data, version);
      begun = true;
    }
    if (!IsLogSeal(*event)) continue;
    const LogSeal seal = ReadLogSeal(*event, {});
    if (seal.whole) version.writer = Named(EscapeControls(seal.says.version));
  }
  return version;
}

void RefuseVersion(const std::filesystem::path& log) {
  throw InputError(fmt::format("{}: error: {}", PathText(log), VersionOf(log).Text()));
}

Scenario ParseLoggedScenario(const std::string& text, const std::filesystem::path& log) {
  try {
    return ParseScenario(text, log.string());
  } catch (const InputError& error) {
    const std::string version = VersionOf(log).Text();
    if (version.empty()) throw;
    throw InputError(fmt::format("{}\n{}: {}", error.what(), PathText(log), version));
  }
}

}  // namespace fogline::log
