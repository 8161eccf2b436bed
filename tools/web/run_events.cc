#include "tools/web/run_events.h"

#include <utility>

#include <fmt/core.h>

#include "services/graph.h"
#include "services/host_modes.h"

namespace fogline::web {
namespace {

std::string_view KindOf(const take_over::TakeOverEntry& entry) {
  if (InEmergency(entry.from) || InEmergency(entry.to)) return "braking";
  if (entry.transfer) return "transfer";
  return InMinimalRisk(entry.to) ? "manoeuvre" : "request";
}

bool IsAlarm(const arbitration_t& command) { return command.doc >= command.threshold; }

}  // namespace

template <class Message>
void RunEvents::Note(const Message& message, std::string_view kind, std::string text) {
  if (events_.size() == kMost) {
    ++left_out_;
    return;
  }
  const double time_s = static_cast<double>(message.utime) / kMicrosPerSecond;
  events_.push_back(
      {.step = message.step, .time_s = time_s, .kind = kind, .text = std::move(text)});
}

void RunEvents::Add(const truth_t& truth) {
  if (truth.header.step <= truth_step_) return;
  if (truth_step_ < 0 && truth.header.step > 0) {
    fog_ = truth.fog_present != 0;
    collision_ = truth.collision;
  }
  truth_step_ = truth.header.step;
  if (const bool fog = truth.fog_present != 0; fog != std::exchange(fog_, fog)) {
    Note(truth.header, "fog", fog ? "fog begins" : "fog ends");
  }
  if (truth.collision == std::exchange(collision_, truth.collision)) return;
  if (truth.collision == truth_t::COLLISION_HOST) {
    Note(truth.header, "collision", "the host hits the preceding car");
  } else if (truth.collision == truth_t::COLLISION_FOLLOWER) {
    Note(truth.header, "collision", "a following car hits the car ahead of it");
  }
}

void RunEvents::Add(const arbitration_t& command, std::optional<double> human_mps2) {
  if (command.header.step <= command_step_) return;
  if (command_step_ < 0 && command.header.step > 0) alarm_ = IsAlarm(command);
  command_step_ = command.header.step;
  NoteAlarm(command);
  take_over_.Add(command, human_mps2);
  for (const take_over::TakeOverEntry& entry : take_over_.TakeEntries()) {
    if (!entry.first) {
      Note(entry, KindOf(entry), std::string(entry.logged));
    } else if (entry.to != arbitration_t::AUTOMATION && entry.to != arbitration_t::HUMAN) {
      Note(entry, KindOf(entry), fmt::format("state {}", take_over::NameOfMode(entry.to)));
    }
  }
}

void RunEvents::NoteAlarm(const arbitration_t& command) {
  const bool alarm = IsAlarm(command);
  if (alarm == std::exchange(alarm_, alarm)) return;
  Note(command.header, "alarm",
       fmt::format("DoC {:.2f} {} the threshold {:.2f}", command.doc,
                   alarm ? "reaches" : "falls below", command.threshold));
}

}  // namespace fogline::web
