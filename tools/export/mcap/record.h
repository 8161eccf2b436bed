// The records of an MCAP file (mcap.dev/spec, version 0): an opcode (one byte), the length of the
// content (uint64), and the content. All numbers are little endian. The names are those of the
// specification, section "Records" and appendix "Serialization".
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "tools/web/types/little_endian.h"

namespace fogline::mcap {

/// Kinds of records (section "Opcodes").
enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0a,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

/// The first and the last bytes of a file (section "Magic").
inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

using web::PutLittleEndian;

/// Appends a value of type String, or a byte array whose length has 32 bits.
inline void PutString(std::string_view text, std::string& to) {
  PutLittleEndian(static_cast<std::uint32_t>(text.size()), to);
  to += text;
}

/// Appends a value of type Map<string, string>.
inline void PutMap(const std::map<std::string, std::string>& map, std::string& to) {
  std::string pairs;
  for (const auto& [key, value] : map) {
    PutString(key, pairs);
    PutString(value, pairs);
  }
  PutString(pairs, to);
}

/// Appends a value of type Map<uint16, uint64>.
inline void PutMap(const std::map<std::uint16_t, std::uint64_t>& map, std::string& to) {
  std::string pairs;
  for (const auto& [key, value] : map) {
    PutLittleEndian(key, pairs);
    PutLittleEndian(value, pairs);
  }
  PutString(pairs, to);
}

inline void PutRecordHead(Opcode opcode, std::uint64_t content_bytes, std::string& to) {
  to += static_cast<char>(opcode);
  PutLittleEndian(content_bytes, to);
}

inline void PutRecord(Opcode opcode, std::string_view content, std::string& to) {
  PutRecordHead(opcode, content.size(), to);
  to += content;
}

}  // namespace fogline::mcap
