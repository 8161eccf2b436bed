// Fuzzes the code with which a restarted recorder, or a runner that resumes a run, reads the log.
// Input: the log file.
#include <algorithm>
#include <stdexcept>

#include "common/errors.h"
#include "services/log/run_log.h"
#include "services/log/step_order.h"
#include "services/recorder/history.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

// A number of bytes at the end of a log, for the parameter `tail` of ReadRemains(). The sample logs
// are longer. So these bytes sometimes show the last complete step, and sometimes not.
constexpr std::int64_t kShortTail = 2500;

void DemandWhereabouts(const log::LogFront& front, const log::Remains& remains,
                       std::int64_t file_size) {
  Demand(front.head.bytes <= remains.head.bytes, "steps follow the scenario");
  Demand(remains.head.bytes <= file_size, "the kept part is in the file");
  Demand(front.head.bytes <= remains.last && remains.last <= remains.head.bytes,
         "the last step is one of the steps");
  Demand((remains.last < remains.head.bytes) == (remains.steps > 0) || front.realtime,
         "the last step takes some bytes");
  Demand(remains.steps >= 0 && !(remains.final && remains.steps == 0 && !front.realtime),
         "no last step without a step");
  if (front.realtime) return;
  Demand(remains.head.events ==
             front.head.events + remains.steps * static_cast<std::int64_t>(log::kStepChannels),
         "the kept part has whole steps");
}

/// Checks the part of a log that a restarted recorder keeps.
/// @param remains the result of ReadRemains() after it has read the whole log
/// @param file has only the kept part
void DemandWholeRun(const log::Remains& remains, const std::filesystem::path& file) {
  log::EventLogReader events(file);
  std::int64_t count = 0;
  while (events.Next()) ++count;
  Demand(count == remains.head.events && events.torn().empty(), "the kept part has whole events");
  log::RunLogReader run(file);
  std::int64_t steps = 0;
  try {
    while (run.Next() != nullptr) ++steps;
  } catch (const InputError&) {
    return;  // the scenario in the log is not valid
  }
  Demand(steps == remains.steps, "the kept part has all complete steps");
}

/// Checks the messages that the recorder would send again.
void DemandAllMessages(const log::LogFront& front, const log::Remains& remains,
                       const std::filesystem::path& file, std::int64_t first) {
  recorder::History history(file, front, remains);
  Demand(history.steps() == remains.steps, "steps are counted");
  for (std::int64_t step = first; step < remains.steps; ++step) {
    std::size_t messages = 0;
    history.ForEachMessage(step, [&](std::string_view channel, runtime::Bytes bytes) {
      Demand(channel == log::kStepNames[messages++], "each channel has a message of each step");
      Demand(runtime::ReadInt64(bytes, runtime::kRunIdOffset) == front.run_id,
             "a message that is handed out is of the run");
      Demand(runtime::ReadInt64(bytes, runtime::kStepOffset) == step,
             "a message that is handed out is of the step");
    });
    Demand(messages == log::kStepChannels, "each step has all its messages");
  }
}

/// If only the end of the log was read, the bytes before the end may have any values. So for a step
/// in these bytes, History may give the step's messages or refuse.
void DemandMessagesOrRefusal(const log::LogFront& front, const log::Remains& remains,
                             const std::filesystem::path& file) {
  const std::int64_t first = std::max<std::int64_t>(0, remains.steps - 10);
  for (std::int64_t step = first; step < remains.steps; ++step) {
    try {
      DemandAllMessages(front, remains, file, step);
    } catch (const std::runtime_error&) {
      continue;
    }
  }
}

void DemandGoesOn(const log::LogFront& front, const log::Remains& remains,
                  const std::filesystem::path& file, std::int64_t tail) {
  {
    log::EventLogWriter log(file, remains.head);
    ForEachStepChannel([&]<class M>(std::size_t channel) {
      M message = Sample<M>(remains.steps);
      message.header.run_id = front.run_id;
      log.Write(kChannels[channel].name, 0, Encoded(message));
    });
  }
  const log::Remains longer = log::ReadRemains(file, front, {}, tail);
  Demand(longer.steps == remains.steps + 1 && longer.last == remains.head.bytes,
         "another step can be added, and those before it stay where they are");
}

void DemandUsefulRemains(runtime::Bytes bytes) {
  const MemoryFile file(bytes);
  const auto size = static_cast<std::int64_t>(bytes.size());
  try {
    const log::LogFront front = log::ReadFront(file.path());
    Demand(front.head.bytes <= size, "the scenario is in the file");
    if (!front.parts.Complete()) return;
    const log::Remains all = log::ReadRemains(file.path(), front, {}, size);
    const log::Remains end = log::ReadRemains(file.path(), front, {}, kShortTail);
    DemandWhereabouts(front, all, size);
    DemandWhereabouts(front, end, size);
    log::OddEnd(file.path(), front, end);
    if (front.realtime) return;
    const MemoryFile kept(bytes.first(static_cast<std::size_t>(all.head.bytes)));
    DemandWholeRun(all, kept.path());
    DemandAllMessages(front, all, file.path(), 0);
    DemandMessagesOrRefusal(front, end, file.path());
    // DemandGoesOn() adds a step to the log, and counts the steps again. If the last kShortTail
    // bytes were enough to count the steps of the old log, they must also be enough for the longer
    // log. Otherwise DemandGoesOn() reads the last `size` bytes.
    DemandGoesOn(front, all, file.path(), end.steps == all.steps ? kShortTail : size);
    if (all.steps > 0) Took();
  } catch (const InputError&) {
    return;  // not an event log
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
