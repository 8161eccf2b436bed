// The seal of a log: its last event, which describes the log at the end of the run
// (lcmtypes/log_seal_t.lcm). The seal shows whether the log was changed after the end of the run.
// Without a key, any person can change the log and make a new seal. With a key, only a person who
// has the key can make a new seal. The seal is not part of the run and not in its digest.
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

/// The channel of log_seal_t. The channel is not part of kGraph, because no process publishes it.
inline constexpr std::string_view kLogSealChannel = "FOGLINE_SEAL";

/// An event that is a seal, or that was a seal before it was changed.
struct LogSeal {
  bool whole = false;               // whether the event itself is unchanged
  log_seal_t says{};                // the contents of the event, if it is whole
  bool copied = false;              // whether the log is a copy that was played and recorded again
  LogHead before{};                 // the part of the log before this event
  std::vector<std::uint8_t> event;  // the event's data, with the signature if there is one
};

/// Whether an event has the channel or the type of a seal. One of the two is sufficient, so a
/// single change cannot make a seal look like another event.
bool IsLogSeal(const Event& event);
/// @pre IsLogSeal(event)
/// @param before the events before this event
LogSeal ReadLogSeal(const Event& event, const LogHead& before);

/// Fills in `seal.check`, and appends the seal to a log.
/// @param before the known events of the log
/// @param key signs the seal; nullptr: no signature
/// @throws std::runtime_error of AppendToLog()
void SealLog(const std::filesystem::path& log, const LogHead& before, log_seal_t seal,
             const runtime::SigningKey* key);

/// Why a run is not the sealed run; "" if it is the sealed run.
/// @param digest the digest of the run
/// @param steps the number of steps that this digest covers
std::string WhyNotSealedRun(const LogSeal& seal, const std::string& digest, std::int64_t steps,
                            const std::string& scenario_hash);

/// Why a file is not the sealed file; "" if it is the sealed file, or a copy (LogSeal::copied). A
/// copy has other event times, so its bytes differ from the sealed bytes. If only the time of the
/// seal was changed, the file also counts as a copy. But then its bytes before the seal are equal
/// to the sealed bytes, and the result states the change.
std::string WhyNotSealedFile(const LogSeal& seal, const EventLogReader& file);

/// The result of verifying a seal's signature.
enum class SealSignature { kNone, kHolds, kWrong };
SealSignature VerifySeal(const LogSeal& seal, const runtime::SigningKey& key);

/// Why a log's bytes differ from the bytes that were written; "" if they do not differ.
/// @param written for each writer of the log, its last report on the part that it has written
std::string WhyNotWritten(const EventLogReader& file, const std::vector<WrittenLog>& written);

}  // namespace fogline::log
