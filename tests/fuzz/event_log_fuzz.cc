// The reader of event logs. Input: the file.
#include <algorithm>

#include "common/errors.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

/// Reads all events. The events are views into `reader`.
std::vector<log::Event> ReadAll(log::EventLogReader& reader, std::size_t file_size) {
  std::vector<log::Event> events;
  std::size_t bytes = 0;
  while (const auto event = reader.Next()) {
    events.push_back(*event);
    bytes += log::SizeInFile(*event);
    Demand(reader.good_bytes() == bytes, "events follow one another without a gap");
  }
  Demand(bytes <= file_size, "no event is larger than the file");
  Demand(reader.torn().empty() == (bytes == file_size), "bytes that are not read are named");
  Demand(!reader.Next(), "after the end nothing follows");
  return events;
}

bool SameBut(std::int64_t number, const log::Event& a, const log::Event& b) {
  return b.number == number && a.utime == b.utime && a.channel == b.channel &&
         std::ranges::equal(a.data, b.data);
}

/// Parses the same bytes in a block of memory that ends where the input ends, and demands the same
/// events. A sanitizer notices a read beyond the end of this block. It does not notice a read
/// beyond the file's end, because the reader maps the file.
void DemandSameInMemory(runtime::Bytes bytes, const std::vector<log::Event>& events) {
  std::string_view why;
  for (const log::Event& event : events) {
    const auto again = log::ParseEvent(bytes, why);
    Demand(again && SameBut(event.number, event, *again), "an event in memory is the same");
    bytes = bytes.subspan(log::SizeInFile(event));
  }
  Demand(!log::ParseEvent(bytes, why) && !why.empty(), "no event in memory follows the last one");
}

void DemandLogOrRefusal(runtime::Bytes bytes) {
  const MemoryFile file(bytes);
  try {
    log::EventLogReader reader(file.path());
    const std::vector<log::Event> events = ReadAll(reader, bytes.size());
    DemandSameInMemory(bytes, events);
    const MemoryFile copy;
    {
      log::EventLogWriter writer(copy.path());
      for (const log::Event& event : events) writer.Write(event.channel, event.utime, event.data);
    }
    log::EventLogReader again(copy.path());
    const std::vector<log::Event> rewritten = ReadAll(again, reader.good_bytes());
    Demand(rewritten.size() == events.size() && again.torn().empty(), "a copy has all events");
    for (std::size_t i = 0; i < events.size(); ++i) {
      Demand(SameBut(static_cast<std::int64_t>(i), events[i], rewritten[i]),
             "a copy has the same events, numbered from 0");
    }
    if (!events.empty()) Took();
  } catch (const InputError&) {
    Demand(bytes.size() > 0, "an empty log is one");
  }
}

}  // namespace

std::vector<Input> Seeds() {
  const Input log = SampleLog();
  const Input torn(log.begin(), log.end() - 9);
  const Input one(log.begin(), log.begin() + 4 + 8 + 8 + 4 + 4 + 3);
  return {log, torn, one};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandLogOrRefusal({data, size});
  return 0;
}
