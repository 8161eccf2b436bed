#include "services/log/event_log.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/errors.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

/// Writes a log of three events. @return its bytes
std::string WriteThreeEvents(const std::string& file) {
  {
    log::EventLogWriter writer(file);
    for (int i = 0; i < 3; ++i) {
      const std::vector<std::uint8_t> data(static_cast<std::size_t>(5 + i),
                                           static_cast<std::uint8_t>(i));
      writer.Write(i == 1 ? "SECOND" : "FIRST", 1000 * i, data);
    }
  }
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(EventLogTest, ReadsBackWhatWasWritten) {
  const test::ScratchFolder folder;
  WriteThreeEvents(folder.File("log"));
  log::EventLogReader reader(folder.File("log"));
  for (int i = 0; i < 3; ++i) {
    const auto event = reader.Next();
    ASSERT_TRUE(event);
    EXPECT_EQ(event->number, i);
    EXPECT_EQ(event->utime, 1000 * i);
    EXPECT_EQ(event->channel, i == 1 ? "SECOND" : "FIRST");
    EXPECT_EQ(event->data.size(), static_cast<std::size_t>(5 + i));
  }
  EXPECT_FALSE(reader.Next());
  EXPECT_EQ(reader.torn(), "");
}

TEST(EventLogTest, ReadsEveryCompleteEventOfALogCutAnywhereAndSaysSo) {
  const test::ScratchFolder folder;
  const std::string bytes = WriteThreeEvents(folder.File("log"));
  const std::size_t first = 28 + 5 + 5;
  const std::size_t second = first + 28 + 6 + 6;
  for (std::size_t size = 4; size <= bytes.size(); ++size) {
    std::ofstream(folder.File("cut"), std::ios::binary)
        .write(bytes.data(), static_cast<long>(size));
    log::EventLogReader reader(folder.File("cut"));
    std::size_t events = 0;
    while (reader.Next()) ++events;
    const std::size_t whole =
        (size >= first ? 1U : 0U) + (size >= second ? 1U : 0U) + (size == bytes.size() ? 1U : 0U);
    EXPECT_EQ(events, whole) << size << " bytes";
    const bool clean = size == first || size == second || size == bytes.size();
    EXPECT_EQ(reader.torn().empty(), clean) << size << " bytes: " << reader.torn();
  }
}

TEST(EventLogTest, StopsAtLengthsThatCannotBe) {
  const test::ScratchFolder folder;
  std::string bytes = WriteThreeEvents(folder.File("log"));
  bytes[24] = '\x7f';  // data length of the first event: 2 GB
  std::ofstream(folder.File("bad"), std::ios::binary) << bytes;
  log::EventLogReader reader(folder.File("bad"));
  EXPECT_FALSE(reader.Next());
  EXPECT_NE(reader.torn(), "");
}

TEST(EventLogTest, RefusesFilesThatAreNoEventLog) {
  const test::ScratchFolder folder;
  std::ofstream(folder.File("text")) << "hello, world";
  EXPECT_THROW(log::EventLogReader(folder.File("text")), InputError);
  EXPECT_THROW(log::EventLogReader(folder.File("missing")), InputError);
  EXPECT_THROW(log::EventLogReader(folder.path()), InputError);
  EXPECT_THROW(log::EventLogWriter(folder.File("no/such/folder/log")), InputError);
}

}  // namespace
}  // namespace fogline
