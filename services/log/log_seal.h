// The seal of a log: its last event, which describes the log at the end of the run
// (lcmtypes/log_seal_t.lcm). It shows whether the log was changed since the end of the run. Without
// a key a person can change the log and make another seal. With a key only a person who has the key
// can do this. The seal is not part of the run and not in its digest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fogline/log_seal_t.hpp"
#include "services/log/event_log.h"
#include "services/runtime/wire/message_signer.h"

namespace fogline::log {

/// The channel of log_seal_t. It is not part of kGraph: no process publishes or reads it.
inline constexpr std::string_view kLogSealChannel = "FOGLINE_SEAL";

/// An event that is a seal, or was one before it was changed.
struct LogSeal {
  bool whole = false;               // the event itself was not changed
  log_seal_t says{};                // its contents, if it is whole
  bool copied = false;              // the log is a copy that was played and recorded again
  LogHead before{};                 // the events before it
  std::vector<std::uint8_t> event;  // its data, with its signature if it has one
};

/// Whether an event is meant to be a seal: by its channel or by its type, so that no single change
/// makes a seal look like another event.
bool IsLogSeal(const Event& event);
/// @pre IsLogSeal(event)
/// @param before the events before it
LogSeal ReadLogSeal(const Event& event, const LogHead& before);

/// Fills in `check`, and appends the seal to a log.
/// @param before all events that the log is known to have
/// @param key signs the seal; nullptr: no signature
/// @throws std::runtime_error if the seal cannot be written; the log is then as it was
void SealLog(const std::filesystem::path& log, const LogHead& before, log_seal_t seal,
             const runtime::SigningKey* key);

/// Why a file is not the one that was sealed; "" if it is. A copy has other event times than the
/// sealed file, so its bytes must differ from the sealed bytes: for a copy the result is "" if they
/// differ.
std::string WhyNotSealedFile(const LogSeal& seal, const EventLogReader& file);

/// The result of verifying a seal's signature.
enum class SealSignature { kNone, kHolds, kWrong };
SealSignature VerifySeal(const LogSeal& seal, const runtime::SigningKey& key);

/// Why a log's bytes differ from those that were written into it; "" if they do not.
/// @param written the last report of each of its writers
std::string WhyNotWritten(const EventLogReader& file, const std::vector<WrittenLog>& written);

}  // namespace fogline::log
