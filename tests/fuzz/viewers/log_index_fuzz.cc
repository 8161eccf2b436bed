// The index of a log that `fogline view` shows. Input: the log.
#include <algorithm>

#include "common/errors.h"
#include "tests/fuzz/samples.h"
#include "tools/web/log/log_index.h"
#include "tools/web/view_messages.h"

namespace fogline::fuzz {
namespace {

void DemandConsistent(const web::LogIndex& index) {
  Demand(index.first_step() >= 0 && index.last_step() < index.run().scenario.steps,
         "the index has steps of the scenario only");
  std::int64_t messages = 0;
  for (std::int64_t step = 0; step <= index.last_step(); ++step) {
    for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
      const runtime::Bytes bytes = index.Message(step, channel);
      if (bytes.empty()) continue;
      ++messages;
      Demand(step >= index.first_step(), "no message is before the first step");
      Demand(bytes.size() >= runtime::kHeaderEnd &&
                 runtime::ReadInt64(bytes, runtime::kRunIdOffset) == index.run().run_id &&
                 runtime::ReadInt64(bytes, runtime::kStepOffset) == step,
             "a message stands at its step and is of the run");
    }
  }
  Demand(messages == index.messages(), "each message of the index is found");
  Demand(index.Message(-1, 0).empty() && index.Message(index.last_step() + 1, 0).empty(),
         "there is nothing beside the steps");
}

void DemandShown(const web::LogIndex& index) {
  const std::int64_t to =
      std::min(index.last_step(), index.first_step() + web::StepsRequest::kMostSteps - 1);
  const std::string frame = web::StepsFrame({.id = 1, .from = index.first_step(), .to = to}, index);
  Demand(frame.size() >= 5, "an answer has a head");
  for (const web::RunEvent& event : index.events()) {
    Demand(event.step >= index.first_step() && event.step <= index.last_step(),
           "an event is of a step");
  }
}

}  // namespace

std::vector<Input> Seeds() {
  const Input log = SampleLog();
  Input cut(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(log.size() * 2 / 3));
  return {log, cut};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogline;
  const fuzz::MemoryFile file({data, size});
  try {
    const web::LogIndex index(file.path());
    fuzz::DemandConsistent(index);
    fuzz::DemandShown(index);
    if (index.messages() > 0) fuzz::Took();
  } catch (const InputError&) {
  }
  return 0;
}
