#include "services/runtime/seat/live_input.h"

#include "common/errors.h"

namespace fogline::runtime {

LiveInput::LiveInput(Parts& parts, const Scenario& scenario)
    : parts_(parts),
      gate_(duration_cast<Duration>(std::chrono::duration<double>(scenario.person.deadman_s))) {
  if (!parts.run.realtime) throw InputError(std::string(kPersonNeedsRealtime));
  parts_.bus.Subscribe(ChannelOf<driver_input_t>().name, [this](Arrival& arrival) {
    // Messages before the first TRUTH are ignored, because the recorder may not have joined yet. So
    // the log has every message that has an effect.
    const bool begun = parts_.inputs.Of(IndexOf<truth_t>()).ring.newest() >= 0;
    if (!parts_.own.Running() || !begun) return;
    if (const RefusalCounter wrong = Take(arrival)) parts_.own.Refuse(wrong);
  });
}

RefusalCounter LiveInput::Take(Arrival& arrival) {
  const Bytes bytes = arrival.bytes();
  if (bytes.size() < kHeaderEnd) return &status_t::malformed;
  if (ReadInt64(bytes, 0) != driver_input_t::getHash()) return &status_t::wrong_type;
  if (ReadInt64(bytes, kRunIdOffset) != *parts_.run.id) return &status_t::foreign;
  if (ReadInt64(bytes, kStepOffset) >= parts_.run.steps) return &status_t::out_of_window;
  const auto* input = arrival.As<driver_input_t>();
  return input != nullptr ? gate_.Take(*input, arrival.time()) : arrival.Wrong<driver_input_t>();
}

}  // namespace fogline::runtime
