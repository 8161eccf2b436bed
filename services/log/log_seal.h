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

/// The channel of log_seal_t. It is not part of kGraph, because no process publishes it.
inline constexpr std::string_view kLogSealChannel = "FOGLINE_SEAL";

/// An event that is a seal, or was one before it was changed.
struct LogSeal {
  bool whole = false;               // the event itself was not changed
  log_seal_t says{};                // the contents of the event, if it is whole
  bool copied = false;              // the log is a copy that was played and recorded again
  LogHead before{};                 // the log before the event
  std::vector<std::uint8_t> event;  // the event's data, with the signature if there is one
};

/// Whether an event is meant to be a seal, by its channel or by its type. So no single change makes
/// a seal look like another event.
bool IsLogSeal(const Event& event);
/// @pre IsLogSeal(event)
/// @param before the events before this one
LogSeal ReadLogSeal(const Event& event, const LogHead& before);

/// Fills in `seal.check`, and appends the seal to a log.
/// @param before all events that the log is known to have
/// @param key signs the seal; nullptr: no signature
/// @throws std::runtime_error if the seal cannot be written; the error says whether the log is as
///     before, or contains a part of the seal
void SealLog(const std::filesystem::path& log, const LogHead& before, log_seal_t seal,
             const runtime::SigningKey* key);

/// Why a file is not the sealed file; "" if it is. A copy (LogSeal::copied) has other event times,
/// so its bytes differ from the sealed bytes: the result is "". Equal bytes in a copy mean that the
/// time of the seal was changed: the result says so.
std::string WhyNotSealedFile(const LogSeal& seal, const EventLogReader& file);

/// The result of verifying a seal's signature.
enum class SealSignature { kNone, kHolds, kWrong };
SealSignature VerifySeal(const LogSeal& seal, const runtime::SigningKey& key);

/// Why a log's bytes differ from the bytes that were written; "" if they do not differ.
/// @param written the last report of each writer of the log
std::string WhyNotWritten(const EventLogReader& file, const std::vector<WrittenLog>& written);

}  // namespace fogline::log
