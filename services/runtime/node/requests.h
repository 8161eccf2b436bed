// The requests that a role sends: RESEND asks another process to publish steps, parts of the
// scenario, or its STATUS again.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "services/runtime/node/own_status.h"
#include "services/runtime/node/run_news.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

class Requests {
 public:
  Requests(Bus& bus, const RunNews& run, const OwnStatus& own) : bus_(bus), run_(run), own_(own) {}

  /// Asks for these steps of a channel. @pre the role is in a run
  void Ask(std::string_view channel, StepRange steps) { AskIn(*run_.id, channel, steps); }
  /// Asks for these steps of a channel in the run `run_id`.
  void AskIn(std::int64_t run_id, std::string_view channel, StepRange steps) {
    resend_t resend{};
    resend.header = {.run_id = run_id, .step = steps.first, .utime = 0};
    resend.channel = channel;
    resend.count = static_cast<std::int32_t>(steps.count);
    resend.requester = own_.message().role;
    resend.instance = own_.message().instance;
    Encode(resend, buffer_);
    bus_.Publish(ChannelOf<resend_t>().name, buffer_);
  }

 private:
  Bus& bus_;
  const RunNews& run_;
  const OwnStatus& own_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace fogline::runtime
