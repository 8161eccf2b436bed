// What a recorder that is started again finds in the log of its predecessor. Input: the file.
#include <algorithm>

#include "scenario/loader.h"
#include "services/recorder/history.h"
#include "services/recorder/run_log.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

std::optional<Remains> Remember(const std::filesystem::path& file) {
  return ReadRemains(file, kRunId, HashOf(kScenarioText));
}

void DemandWhereabouts(const Remains& remains, std::size_t file_size) {
  std::int64_t end = remains.begin;
  for (const std::int64_t next : remains.ends) {
    Demand(next > end, "each step takes some bytes behind the one before");
    end = next;
  }
  Demand(remains.head.bytes == end, "what is kept ends with the last complete step");
  Demand(end <= static_cast<std::int64_t>(file_size), "what is kept is in the file");
  Demand(!remains.final || !remains.ends.empty(), "no last step without a step");
}

/// The log that is gone on with.
void DemandWholeRun(const Remains& remains, const std::filesystem::path& file) {
  EventLogReader events(file);
  std::int64_t count = 0;
  while (events.Next()) ++count;
  Demand(count == remains.head.events && events.torn().empty(), "what is kept is whole events");
  RunLogReader run(file);
  std::size_t steps = 0;
  try {
    while (run.Next() != nullptr) ++steps;
  } catch (const InputError&) {
    Demand(false, "what is kept is the beginning of a run");
  }
  Demand(steps == remains.ends.size(), "what is kept is all complete steps");
}

/// What is handed out again.
void DemandAllMessages(const Remains& remains, const std::filesystem::path& file) {
  History history(file, remains.begin);
  for (const std::int64_t end : remains.ends) history.Add(end);
  Demand(history.steps() == static_cast<std::int64_t>(remains.ends.size()), "steps are counted");
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace != Pace::kStep) continue;
    std::int64_t step = 0;
    history.ForEach(channel.name, {.first = 0, .count = history.steps()}, [&step](Bytes bytes) {
      Demand(ReadInt64(bytes, kRunIdOffset) == kRunId, "what is handed out is of the run");
      Demand(ReadInt64(bytes, kStepOffset) == step++, "what is handed out is of the step");
    });
    Demand(step == history.steps(), "each channel has a message of each step");
  }
}

void DemandGoesOn(const Remains& remains, const std::filesystem::path& file) {
  const auto step = static_cast<std::int64_t>(remains.ends.size());
  {
    EventLogWriter log(file, remains.head);
    ForEachStepChannel([&]<class M>(std::size_t channel) {
      log.Write(kChannels[channel].name, 0, Encoded(Sample<M>(step)));
    });
  }
  const auto longer = Remember(file);
  Demand(longer && longer->begin == remains.begin && longer->ends.size() == remains.ends.size() + 1,
         "another step can be added");
  Demand(std::equal(remains.ends.begin(), remains.ends.end(), longer->ends.begin()),
         "the steps before it stay where they are");
}

void DemandUsefulRemains(Bytes bytes) {
  const MemoryFile file(bytes);
  try {
    const auto remains = Remember(file.path());
    if (!remains) return;
    DemandWhereabouts(*remains, bytes.size());
    const MemoryFile kept(bytes.first(static_cast<std::size_t>(remains->head.bytes)));
    DemandWholeRun(*remains, kept.path());
    DemandAllMessages(*remains, file.path());
    DemandGoesOn(*remains, file.path());
    if (!remains->ends.empty()) Took();
  } catch (const InputError&) {
    return;  // no event log, or that of another run
  }
}

}  // namespace

std::vector<Input> Seeds() {
  const Input log = SampleLog();
  const Input torn(log.begin(), log.end() - 9);
  const Input little(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(log.size() / 3));
  return {log, torn, little};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandUsefulRemains({data, size});
  return 0;
}
