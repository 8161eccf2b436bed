#include "services/log/log_seal.h"

#include <libdeflate.h>

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "services/runtime/wire/digest.h"

namespace fogline::log {
namespace {

std::string HashOfBytes(runtime::Bytes bytes) {
  return runtime::HashOf({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// The correct value of log_seal_t::check.
std::int64_t CheckOf(log_seal_t seal) {
  seal.check = 0;
  std::vector<std::uint8_t> bytes;
  runtime::Encode(seal, bytes);
  constexpr int kHexadecimal = 16;
  constexpr std::size_t kDigits = 2 * sizeof(std::int64_t);
  return static_cast<std::int64_t>(
      std::stoull(HashOfBytes(bytes).substr(0, kDigits), nullptr, kHexadecimal));
}

std::uint32_t ChecksumOf(std::uint32_t before, runtime::Bytes bytes) {
  return libdeflate_crc32(before, bytes.data(), bytes.size());
}

}  // namespace

bool IsLogSeal(const Event& event) {
  return event.channel == kLogSealChannel ||
         (event.data.size() >= runtime::kHeaderEnd &&
          runtime::ReadInt64(event.data, 0) == log_seal_t::getHash());
}

LogSeal ReadLogSeal(const Event& event, const LogHead& before) {
  LogSeal seal;
  seal.before = before;
  seal.event.assign(event.data.begin(), event.data.end());
  const bool decodes = runtime::Decode(event.data, seal.says) ||
                       (runtime::LooksSigned(event.data) &&
                        runtime::Decode(runtime::WithoutSignature(event.data), seal.says));
  seal.whole = decodes && event.channel == kLogSealChannel && seal.says.check == CheckOf(seal.says);
  if (!seal.whole) seal.says = {};
  seal.copied = event.utime != seal.says.header.utime;
  return seal;
}

void SealLog(const std::filesystem::path& log, const LogHead& before, log_seal_t seal,
             const runtime::SigningKey* key) {
  seal.check = CheckOf(seal);
  std::vector<std::uint8_t> data;
  runtime::Encode(seal, data);
  if (key != nullptr) {
    runtime::MessageSigner signer(*key, Role::kRunner);
    const runtime::Bytes with_signature = signer.Sign(kLogSealChannel, data);
    data = std::vector<std::uint8_t>(with_signature.begin(), with_signature.end());
  }
  AppendToLog(log, before, kLogSealChannel, seal.header.utime, data);
}

std::string WhyNotSealedRun(const LogSeal& seal, const std::string& digest, std::int64_t steps,
                            const std::string& scenario_hash) {
  if (!seal.whole) return "its seal was changed";
  if (seal.says.digest != digest || seal.says.steps != steps) {
    return fmt::format("the seal names digest {} of {} steps; the log has {} of {}",
                       EscapeControls(seal.says.digest), seal.says.steps, digest, steps);
  }
  if (seal.says.scenario_hash != scenario_hash) return "it was sealed with another scenario";
  return "";
}

std::string WhyNotSealedFile(const LogSeal& seal, const EventLogReader& file) {
  const auto before = static_cast<std::size_t>(seal.before.bytes);
  runtime::Hash hash;
  file.ReadThrough(0, before, [&hash](runtime::Bytes piece) { hash.Add(piece); });
  const bool same = hash.Hex() == seal.says.file_hash;
  if (seal.copied) return same ? "the time of its seal was changed" : "";
  if (!same) return "the bytes differ from the sealed ones";
  std::string_view why;
  const runtime::Bytes last = file.content().subspan(before);
  const auto event = ParseEvent(last, why);
  if (!event || event->number != seal.before.events) return "the number of its seal was changed";
  if (SizeInFile(*event) != last.size()) {
    return fmt::format("{} bytes after the seal", last.size() - SizeInFile(*event));
  }
  return "";
}

SealSignature VerifySeal(const LogSeal& seal, const runtime::SigningKey& key) {
  switch (runtime::MessageSigner(key, std::nullopt).Open(kLogSealChannel, seal.event).verdict) {
    case runtime::MessageSigner::Verdict::kGood:
      return SealSignature::kHolds;
    case runtime::MessageSigner::Verdict::kNotSigned:
      return SealSignature::kNone;
    case runtime::MessageSigner::Verdict::kBadlySigned:
      break;
  }
  return SealSignature::kWrong;
}

std::string WhyNotWritten(const EventLogReader& file, const std::vector<WrittenLog>& written) {
  for (const WrittenLog& told : written) {
    const std::size_t to = std::min(file.content().size(), static_cast<std::size_t>(told.bytes));
    const std::size_t from = std::min(to, static_cast<std::size_t>(told.begin));
    std::uint32_t checksum = 0;
    file.ReadThrough(from, to,
                     [&](runtime::Bytes piece) { checksum = ChecksumOf(checksum, piece); });
    if (std::cmp_equal(to, told.bytes) && checksum == told.checksum) continue;
    return fmt::format(
        "the log on disk is not what the recorder wrote: it wrote {} bytes with checksum {:08x}, "
        "on disk are {} with {:08x}",
        told.bytes, told.checksum, to, checksum);
  }
  return "";
}

}  // namespace fogline::log
