// The choice of the run that a live view shows, and the events of this run. Input: messages. Each
// message has an index into kChannels, the time since the previous message in units of 10 ms, and a
// flag that tells whether TakeEvents() is called after this message.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "tests/fuzz/samples.h"
#include "tools/web/run_tracker.h"

namespace fogline::fuzz {
namespace {

void AddMessage(std::size_t channel, const Input& bytes, Input& input) {
  input.insert(input.end(), {static_cast<std::uint8_t>(channel), 1, 0});
  AddDatagram(bytes, input);
}

void DemandDescribed(const web::RunTracker& tracker) {
  Demand(tracker.run().has_value() == (tracker.runs() > 0), "a run is shown and counted");
  if (!tracker.run()) return Demand(tracker.run_text().empty(), "no run has no text");
  const auto json = nlohmann::json::parse(tracker.run_text(), nullptr, false);
  Demand(json.is_object() && json["op"] == "run" && json["scenario"].is_object(),
         "a run is described by its scenario");
}

}  // namespace

std::vector<Input> Seeds() {
  Input scenario;
  for (const run_t& run : RunParts(kScenarioText, 10)) {
    AddMessage(IndexOf<run_t>(), Encoded(run), scenario);
  }
  Input steps = scenario;
  for (std::int64_t step = 0; step < kSteps; ++step) {
    ForEachStepChannel([&]<class M>(std::size_t channel) {
      AddMessage(channel, Encoded(Sample<M>(step)), steps);
    });
  }
  Input again = steps;
  again.insert(again.end(), steps.begin(), steps.end());
  return {scenario, steps, again};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogline;
  using fuzz::Demand;
  fuzz::Cutter input({data, size});
  web::RunTracker tracker;
  TimePoint now{};
  while (!input.empty()) {
    const std::size_t channel = input.Byte() % (kNumChannels + 1);
    now += milliseconds(10) * input.Byte();
    const bool takes = input.Byte() % 2 == 1;
    const std::int64_t runs = tracker.runs();
    tracker.Hear(channel, input.Datagram(), now);
    Demand(tracker.runs() == runs || tracker.runs() == runs + 1, "a message is of one run");
    Demand(tracker.events().size() <= web::RunEvents::kMost, "the list of events is bounded");
    if (tracker.runs() != runs) fuzz::DemandDescribed(tracker);
    if (!takes) continue;
    const auto news = tracker.TakeEvents();
    const auto& all = tracker.events();
    Demand(news.size() <= all.size() && std::equal(news.rbegin(), news.rend(), all.rbegin(),
                                                   [](const auto& a, const auto& b) {
                                                     return a.step == b.step && a.text == b.text;
                                                   }),
           "what is told are the newest events");
    Demand(tracker.TakeEvents().empty(), "no event is told twice");
  }
  fuzz::DemandDescribed(tracker);
  if (tracker.run()) fuzz::Took();
  return 0;
}
