#include "tools/export/mcap/writer.h"

#include <libdeflate.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>

#include <fmt/core.h>

namespace fogline::mcap {
namespace {

/// A chunk is complete when it has at least this size. A reader must decompress a whole chunk for
/// one message, so chunks should be small. Chunks of 1 MiB compress nearly as well as larger ones.
constexpr std::size_t kChunkBytes = 1 << 20;
constexpr std::string_view kCompression = "zstd";

std::uint32_t Crc(std::uint32_t before, std::string_view bytes) {
  return bytes.empty() ? before : libdeflate_crc32(before, bytes.data(), bytes.size());
}

}  // namespace

void Writer::FreeContext::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }

void Writer::Times::Add(std::uint64_t time) {
  first = any ? std::min(first, time) : time;
  last = any ? std::max(last, time) : time;
  any = true;
}

Writer::Writer(Sink sink, std::string_view library)
    : sink_(std::move(sink)), compressor_(ZSTD_createCCtx()) {
  if (compressor_ == nullptr) throw std::bad_alloc();
  Put(kMagic);
  std::string header;
  PutString("", header);  // profile: none
  PutString(library, header);
  Put(Opcode::kHeader, header);
}

Writer::~Writer() = default;

void Writer::Put(std::string_view bytes) {
  sink_(bytes);
  offset_ += bytes.size();
  crc_ = Crc(crc_, bytes);
}

std::uint64_t Writer::Put(Opcode opcode, std::string_view content) {
  const std::uint64_t begin = offset_;
  std::string head;
  PutRecordHead(opcode, content.size(), head);
  Put(head);
  Put(content);
  ++records_written_[opcode];
  return begin;
}

SchemaId Writer::AddSchema(std::string_view name, std::string_view encoding,
                           std::string_view data) {
  const auto id = static_cast<SchemaId>(records_written_[Opcode::kSchema] + 1);  // 0: no schema
  std::string content;
  PutLittleEndian(id, content);
  PutString(name, content);
  PutString(encoding, content);
  PutString(data, content);
  Put(Opcode::kSchema, content);
  PutRecord(Opcode::kSchema, content, groups_[Opcode::kSchema]);
  return id;
}

ChannelId Writer::AddChannel(SchemaId schema, std::string_view topic, std::string_view encoding,
                             const std::map<std::string, std::string>& metadata) {
  const auto id = static_cast<ChannelId>(records_written_[Opcode::kChannel]);
  std::string content;
  PutLittleEndian(id, content);
  PutLittleEndian(schema, content);
  PutString(topic, content);
  PutString(encoding, content);
  PutMap(metadata, content);
  Put(Opcode::kChannel, content);
  PutRecord(Opcode::kChannel, content, groups_[Opcode::kChannel]);
  return id;
}

void Writer::Write(ChannelId channel, const Message& message) {
  entries_[channel].emplace_back(message.log_time, records_.size());
  std::string content;
  PutLittleEndian(channel, content);
  PutLittleEndian(message.sequence, content);
  PutLittleEndian(message.log_time, content);
  PutLittleEndian(message.publish_time, content);
  content += message.data;
  PutRecord(Opcode::kMessage, content, records_);
  times_.Add(message.log_time);
  all_times_.Add(message.log_time);
  ++counts_[channel];
  if (records_.size() >= kChunkBytes) PutChunk();
}

void Writer::PutChunk() {
  if (records_.empty()) return;
  std::string compressed(ZSTD_compressBound(records_.size()), '\0');
  const std::size_t size =
      ZSTD_compressCCtx(compressor_.get(), compressed.data(), compressed.size(), records_.data(),
                        records_.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0) {
    throw std::runtime_error(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
  }
  compressed.resize(size);

  std::string chunk;
  PutLittleEndian(times_.first, chunk);
  PutLittleEndian(times_.last, chunk);
  PutLittleEndian(std::uint64_t{records_.size()}, chunk);
  PutLittleEndian(Crc(0, records_), chunk);
  PutString(kCompression, chunk);
  PutLittleEndian(std::uint64_t{size}, chunk);
  chunk += compressed;
  const std::uint64_t begin = Put(Opcode::kChunk, chunk);
  const std::uint64_t length = offset_ - begin;

  std::map<ChannelId, std::uint64_t> index_offsets;
  const std::uint64_t index_length = PutMessageIndexes(index_offsets);

  std::string index;
  PutLittleEndian(times_.first, index);
  PutLittleEndian(times_.last, index);
  PutLittleEndian(begin, index);
  PutLittleEndian(length, index);
  PutMap(index_offsets, index);
  PutLittleEndian(index_length, index);
  PutString(kCompression, index);
  PutLittleEndian(std::uint64_t{size}, index);
  PutLittleEndian(std::uint64_t{records_.size()}, index);
  PutRecord(Opcode::kChunkIndex, index, groups_[Opcode::kChunkIndex]);

  records_.clear();
  times_ = {};
  entries_.clear();
}

/// Writes the Message Index records of the chunk.
/// @param offsets gets the offset in the file of each channel's Message Index
/// @return number of bytes of all these records
std::uint64_t Writer::PutMessageIndexes(std::map<ChannelId, std::uint64_t>& offsets) {
  const std::uint64_t begin = offset_;
  for (auto& [channel, entries] : entries_) {
    std::ranges::stable_sort(entries);
    std::string pairs;
    for (const auto& [time, offset] : entries) {
      PutLittleEndian(time, pairs);
      PutLittleEndian(offset, pairs);
    }
    std::string content;
    PutLittleEndian(channel, content);
    PutString(pairs, content);
    offsets[channel] = Put(Opcode::kMessageIndex, content);
  }
  return offset_ - begin;
}

void Writer::AddAttachment(std::string_view name, std::string_view media_type,
                           std::string_view data) {
  constexpr std::uint64_t kNoTime =
      0;  // log_time, create_time: the attachment belongs to no moment
  std::string content;
  PutLittleEndian(kNoTime, content);
  PutLittleEndian(kNoTime, content);
  PutString(name, content);
  PutString(media_type, content);
  PutLittleEndian(std::uint64_t{data.size()}, content);
  content += data;
  PutLittleEndian(Crc(0, content), content);
  const std::uint64_t begin = Put(Opcode::kAttachment, content);

  std::string index;
  PutLittleEndian(begin, index);
  PutLittleEndian(offset_ - begin, index);
  PutLittleEndian(kNoTime, index);
  PutLittleEndian(kNoTime, index);
  PutLittleEndian(std::uint64_t{data.size()}, index);
  PutString(name, index);
  PutString(media_type, index);
  PutRecord(Opcode::kAttachmentIndex, index, groups_[Opcode::kAttachmentIndex]);
}

void Writer::AddMetadata(std::string_view name,
                         const std::map<std::string, std::string>& metadata) {
  std::string content;
  PutString(name, content);
  PutMap(metadata, content);
  const std::uint64_t begin = Put(Opcode::kMetadata, content);

  std::string index;
  PutLittleEndian(begin, index);
  PutLittleEndian(offset_ - begin, index);
  PutString(name, index);
  PutRecord(Opcode::kMetadataIndex, index, groups_[Opcode::kMetadataIndex]);
}

std::string Writer::Statistics() const {
  const auto count = [this](Opcode opcode) {
    const auto written = records_written_.find(opcode);
    return written == records_written_.end() ? 0 : written->second;
  };
  std::uint64_t messages = 0;
  for (const auto& [channel, channel_messages] : counts_) messages += channel_messages;
  std::string content;
  PutLittleEndian(messages, content);
  PutLittleEndian(static_cast<std::uint16_t>(count(Opcode::kSchema)), content);
  for (const Opcode opcode :
       {Opcode::kChannel, Opcode::kAttachment, Opcode::kMetadata, Opcode::kChunk}) {
    PutLittleEndian(count(opcode), content);
  }
  PutLittleEndian(all_times_.first, content);
  PutLittleEndian(all_times_.last, content);
  PutMap(counts_, content);
  return content;
}

void Writer::Finish() {
  PutChunk();
  std::string data_end;
  PutLittleEndian(crc_, data_end);  // data_section_crc: of all bytes before this record
  Put(Opcode::kDataEnd, data_end);
  PutRecord(Opcode::kStatistics, Statistics(), groups_[Opcode::kStatistics]);
  PutSummary();
  Put(kMagic);
}

/// Writes the sections "Summary Section" and "Summary Offset Section", and the Footer.
void Writer::PutSummary() {
  crc_ = 0;
  const std::uint64_t summary_start = offset_;
  std::string offsets;
  for (const auto& [opcode, records] : groups_) {
    std::string content;
    content += static_cast<char>(opcode);
    PutLittleEndian(offset_, content);
    PutLittleEndian(std::uint64_t{records.size()}, content);
    PutRecord(Opcode::kSummaryOffset, content, offsets);
    Put(records);
  }
  const std::uint64_t summary_offset_start = offset_;
  Put(offsets);
  // summary_crc is the CRC of all bytes from summary_start to the last byte before summary_crc.
  std::string footer;
  PutLittleEndian(summary_start, footer);
  PutLittleEndian(summary_offset_start, footer);
  constexpr std::size_t kFooterBytes = 20;
  std::string head;
  PutRecordHead(Opcode::kFooter, kFooterBytes, head);
  PutLittleEndian(Crc(Crc(crc_, head), footer), footer);
  Put(head);
  Put(footer);
}

}  // namespace fogline::mcap
