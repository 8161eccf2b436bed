#include "tools/export/mcap/writer.h"

#include <zlib.h>

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/web/types/little_endian.h"

// zlib computes the expected checksums. tests/integration/logs/mcap.test.js reads such files with
// MCAP's own library.
namespace fogline::mcap {
namespace {

using testing::EndsWith;
using testing::StartsWith;

std::uint32_t Crc(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

template <class Number>
Number At(std::string_view file, std::size_t offset) {
  std::string_view rest = file.substr(offset);
  return web::TakeLittleEndian<Number>(rest);
}

/// A file with `messages` messages of `bytes` bytes.
std::string FileWith(int messages, std::size_t bytes) {
  std::string file;
  Writer writer([&file](std::string_view piece) { file += piece; }, "test");
  const SchemaId schema = writer.AddSchema("p.t", "protobuf", "descriptor");
  const ChannelId channel = writer.AddChannel(schema, "T", "protobuf", {{"from", "world"}});
  const std::string data(bytes, 'x');
  for (int i = 0; i < messages; ++i) {
    writer.Write(channel, {.sequence = static_cast<std::uint32_t>(i),
                           .log_time = static_cast<std::uint64_t>(i) * 100,
                           .publish_time = static_cast<std::uint64_t>(i) * 100,
                           .data = data});
  }
  writer.AddAttachment("a.json", "application/json", "{}");
  writer.AddMetadata("facts", {{"digest", "0"}});
  writer.Finish();
  return file;
}

constexpr std::size_t kMagicBytes = 8;
constexpr std::size_t kRecordHead = 9;    // opcode and length
constexpr std::size_t kFooterBytes = 20;  // without opcode and length

/// The number of records of each kind outside of chunks.
std::map<int, int> RecordsOf(std::string_view file) {
  std::map<int, int> records;
  for (std::size_t at = kMagicBytes; at < file.size() - kMagicBytes;) {
    ++records[static_cast<unsigned char>(file[at])];
    at += kRecordHead + At<std::uint64_t>(file, at + 1);
  }
  return records;
}

TEST(McapWriterTest, EndsWithASummaryWhoseChecksumHolds) {
  const std::string file = FileWith(3, 10);
  EXPECT_THAT(file, StartsWith(std::string(kMagic)));
  EXPECT_THAT(file, EndsWith(std::string(kMagic)));
  const std::size_t footer = file.size() - kMagicBytes - kFooterBytes;
  EXPECT_EQ(file[footer - kRecordHead], 2);
  const auto summary = At<std::uint64_t>(file, footer);
  const auto offsets = At<std::uint64_t>(file, footer + 8);
  ASSERT_LT(summary, offsets);
  EXPECT_EQ(At<std::uint32_t>(file, footer + 16),
            Crc(std::string_view(file).substr(summary, footer + 16 - summary)));
  EXPECT_EQ(file[offsets], 0x0e) << "a Summary Offset";
}

TEST(McapWriterTest, HasAChecksumOfAllBytesBeforeTheEndOfTheData) {
  const std::string file = FileWith(3, 10);
  const auto summary = At<std::uint64_t>(file, file.size() - kMagicBytes - kFooterBytes);
  const std::size_t data_end = summary - kRecordHead - sizeof(std::uint32_t);
  EXPECT_EQ(file[data_end], 0x0f);
  EXPECT_EQ(At<std::uint32_t>(file, summary - sizeof(std::uint32_t)),
            Crc(std::string_view(file).substr(0, data_end)));
}

TEST(McapWriterTest, WritesAChunkForEachMebibyteAndCompressesIt) {
  const std::string file = FileWith(5000, 1000);  // 5.1 MB of records
  EXPECT_LT(file.size(), 1'000'000U);
  const std::map<int, int> records = RecordsOf(file);
  EXPECT_EQ(records.at(0x06), 5) << "Chunk";
  EXPECT_EQ(records.at(0x07), 5) << "Message Index, one for the channel in each chunk";
  EXPECT_EQ(records.at(0x08), 5) << "Chunk Index";
  EXPECT_EQ(records.at(0x03), 2) << "Schema, in the data and in the summary";
  EXPECT_EQ(records.at(0x0e), 6) << "Summary Offset, one for each kind of record in the summary";
}

TEST(McapWriterTest, OfNothingIsAWholeFile) {
  const std::map<int, int> records = RecordsOf(FileWith(0, 0));
  EXPECT_FALSE(records.contains(0x06));
  EXPECT_EQ(records.at(0x0b), 1) << "Statistics";
}

TEST(McapWriterTest, PassesOnWhatTheSinkThrows) {
  EXPECT_THROW(Writer([](std::string_view) { throw std::runtime_error("disk full"); }, "test"),
               std::runtime_error);
}

}  // namespace
}  // namespace fogline::mcap
