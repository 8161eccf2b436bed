// The seal of a log: its last event, which says what the log held when the run ended
// (lcmtypes/log_seal_t.lcm). It shows that a log was changed since then. With a key it shows also
// that it was changed on purpose: only those who have the key can make another seal. It is no part
// of the run and not in its digest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fogline/log_seal_t.hpp"
#include "services/recorder/event_log.h"
#include "services/runtime/seal.h"

namespace fogline {

/// The channel of log_seal_t. It is no part of kGraph: no process says or hears it.
inline constexpr std::string_view kLogSealChannel = "FOGLINE_SEAL";

/// An event that is a seal, or that was one.
struct LogSeal {
  bool whole = false;               // nothing of the event itself was changed
  log_seal_t says{};                // what it says, if it is whole
  bool copied = false;              // it stands in a log that was played and recorded again
  LogHead before{};                 // the events before it
  std::vector<std::uint8_t> event;  // its data, with the signature if there is one
};

/// Whether an event is meant to be a seal: by its channel or by its type, so that no single change
/// makes a sealed log one without a seal.
bool IsLogSeal(const Event& event);
/// @pre IsLogSeal(event)
/// @param before the events before it
LogSeal ReadLogSeal(const Event& event, const LogHead& before);

/// Fills in `check`, and puts the event behind a log.
/// @param log of which `before` is known to be all
/// @param key signs it; nullptr: no signature
/// @throws std::runtime_error if it cannot be written; the log is then as it was
void SealLog(const std::filesystem::path& log, const LogHead& before, log_seal_t seal,
             const SealKey* key);

/// Why a file is not the one that was sealed, "" if it is. Of a copy, whose events have times of
/// their own, there is nothing to say.
std::string WhyNotSealedFile(const LogSeal& seal, const EventLogReader& file);

/// What the signature of a seal is worth.
enum class SealSignature { kNone, kHolds, kWrong };
SealSignature VerifySeal(const LogSeal& seal, const SealKey& key);

/// Why a log's bytes are not what was written into it, "" if they are.
/// @param written what its writers, one after another, have told last
std::string WhyNotWritten(const EventLogReader& file, const std::vector<WrittenLog>& written);

}  // namespace fogline
