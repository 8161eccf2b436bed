// The joining of a scenario's parts. Input: datagrams on the channel RUN.
#include <map>

#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

/// A simple reference implementation of ScenarioParts.
struct Model {
  std::int32_t num_parts = 0;
  std::string hash;
  std::map<std::int64_t, std::string> parts;

  void Add(const run_t& run) {
    if (run.num_parts < 1 || run.num_parts > runtime::ScenarioParts::kMaxParts) return;
    if (run.header.step < 0 || run.header.step >= run.num_parts || run.text.empty()) return;
    if (num_parts == 0) {
      num_parts = run.num_parts;
      hash = run.scenario_hash;
    }
    if (run.num_parts == num_parts && run.scenario_hash == hash) {
      parts.emplace(run.header.step, run.text);
    }
  }
  bool Complete() const {
    return num_parts > 0 && parts.size() == static_cast<std::size_t>(num_parts);
  }
};

void DemandWholeText(const Model& model, const runtime::ScenarioParts& parts) {
  Demand(parts.Complete() == model.Complete(), "it is complete when every part is there");
  if (!parts.Complete()) {
    const std::int64_t missing = parts.FirstMissing();
    Demand(missing >= 0 && !model.parts.contains(missing), "a part that is missing is missing");
    return;
  }
  std::string text;
  for (const auto& [number, part] : model.parts) text += part;
  Demand(parts.Text() == text, "the text is the first that came of each part, in order");
  Demand(parts.HashHolds() == (runtime::HashOf(text) == model.hash),
         "another text has another hash");
  if (parts.HashHolds()) Took();
}

}  // namespace

std::vector<Input> Seeds() {
  std::vector<run_t> runs = RunParts(kScenarioText, 6);
  Input in_order;
  for (const run_t& run : runs) AddDatagram(Encoded(run), in_order);
  std::swap(runs.front(), runs.back());
  Input repeated;
  for (const run_t& run : runs) AddDatagram(Encoded(run), repeated);
  for (const run_t& run : runs) AddDatagram(Encoded(run), repeated);
  return {in_order, repeated};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogline;
  fuzz::Model model;
  runtime::ScenarioParts parts;
  for (fuzz::Cutter cutter({data, size}); !cutter.empty();) {
    run_t run{};
    if (!runtime::Decode(cutter.Datagram(), run)) continue;
    model.Add(run);
    static_cast<void>(parts.Add(run));
  }
  fuzz::DemandWholeText(model, parts);
  return 0;
}
