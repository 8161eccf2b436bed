// Writes an MCAP file (mcap.dev/spec, version 0): chunks that zstd compresses, an index of the
// messages of each chunk, and a summary. With the summary, a reader finds the messages of a time
// without reading the whole file. Attachments and metadata are written immediately. The writer
// keeps one chunk in memory, and 100 to 300 bytes for each chunk that was written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/export/mcap/record.h"

struct ZSTD_CCtx_s;

namespace fogline::mcap {

using SchemaId = std::uint16_t;
using ChannelId = std::uint16_t;

/// Times are in nanoseconds. The caller chooses the epoch.
struct Message {
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;
  std::uint64_t publish_time = 0;
  std::string_view data;
};

class Writer {
 public:
  using Sink = std::function<void(std::string_view)>;

  /// Writes the beginning of the file (magic and Header).
  /// @param sink takes the bytes of the file. An exception of `sink` reaches the caller
  /// @param library the program that writes the file
  Writer(Sink sink, std::string_view library);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// @param encoding a well-known schema encoding (mcap.dev/spec/registry), such as "protobuf"
  SchemaId AddSchema(std::string_view name, std::string_view encoding, std::string_view data);
  /// @param encoding a well-known message encoding, such as "protobuf"
  ChannelId AddChannel(SchemaId schema, std::string_view topic, std::string_view encoding,
                       const std::map<std::string, std::string>& metadata);
  /// The messages may come in any order of time. A reader finds the messages of a chunk fastest if
  /// they came in the order of log_time.
  /// @throws std::runtime_error if zstd fails
  void Write(ChannelId channel, const Message& message);
  void AddAttachment(std::string_view name, std::string_view media_type, std::string_view data);
  void AddMetadata(std::string_view name, const std::map<std::string, std::string>& metadata);
  /// Completes the file: writes the last chunk, Data End, the summary with its offsets, Footer and
  /// magic.
  void Finish();

 private:
  /// The range of log_time of some messages, both ends included; 0 if there is no message.
  struct Times {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    bool any = false;
    void Add(std::uint64_t time);
  };
  /// Entries of a Message Index, of type Array<Tuple<Timestamp, uint64>>: log_time of a message,
  /// and its offset in the uncompressed chunk.
  using Entries = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

  void Put(std::string_view bytes);
  /// @return the offset of the record
  std::uint64_t Put(Opcode opcode, std::string_view content);
  void PutChunk();
  std::uint64_t PutMessageIndexes(std::map<ChannelId, std::uint64_t>& offsets);
  void PutSummary();
  std::string Statistics() const;

  struct FreeContext {
    void operator()(ZSTD_CCtx_s* context) const;
  };

  Sink sink_;
  std::uint64_t offset_ = 0;  // bytes of the file so far
  std::uint32_t crc_ = 0;     // CRC-32 of these bytes; after Data End only of the summary
  std::unique_ptr<ZSTD_CCtx_s, FreeContext> compressor_;

  // The current chunk.
  std::string records_;
  Times times_;
  std::map<ChannelId, Entries> entries_;

  // The summary. Each group has all records with one opcode.
  std::map<Opcode, std::string> groups_;
  Times all_times_;
  std::map<ChannelId, std::uint64_t> counts_;
  std::map<Opcode, std::uint32_t> records_written_;
};

}  // namespace fogline::mcap
