#include "tools/web/run_events.h"

#include <utility>

#include <fmt/core.h>

#include "services/graph.h"
#include "services/host_modes.h"
#include "services/log/gaps/log_gaps.h"

namespace fogline::web {
namespace {

std::string_view KindOf(const take_over::TakeOverEntry& entry) {
  if (InEmergency(entry.from) || InEmergency(entry.to)) return "braking";
  if (entry.transfer) return "transfer";
  if (InMinimalRisk(entry.to)) return "manoeuvre";
  return entry.from == entry.to && !entry.first ? "input" : "request";
}

bool IsAlarm(const arbitration_t& command) { return command.doc >= command.threshold; }

}  // namespace

template <class Message>
void RunEvents::Note(const Message& message, std::int64_t earliest, std::string_view kind,
                     std::string text) {
  if (events_.size() == kMost) {
    ++left_out_;
    return;
  }
  text += log::InOneOfTheSteps(earliest, message.step);
  const double time_s = static_cast<double>(message.utime) / kMicrosPerSecond;
  events_.push_back({.number = events_.size(),
                     .step = message.step,
                     .time_s = time_s,
                     .kind = kind,
                     .text = std::move(text)});
}

void RunEvents::Add(const truth_t& truth) {
  if (truth.header.step <= truth_step_) return;
  if (truth_step_ < 0 && truth.header.step > 0) {
    fog_ = truth.fog_present != 0;
    collision_ = truth.collision;
  }
  const std::int64_t earliest = std::exchange(truth_step_, truth.header.step) + 1;
  if (const bool fog = truth.fog_present != 0; fog != std::exchange(fog_, fog)) {
    Note(truth.header, earliest, "fog", fog ? "fog begins" : "fog ends");
  }
  NoteCollision(truth, earliest);
}

void RunEvents::NoteCollision(const truth_t& truth, std::int64_t earliest) {
  if (truth.collision == std::exchange(collision_, truth.collision)) return;
  if (truth.collision == truth_t::COLLISION_HOST) {
    Note(truth.header, earliest, "collision", "the host hits the preceding car");
  } else if (truth.collision == truth_t::COLLISION_FOLLOWER) {
    Note(truth.header, earliest, "collision", "a following car hits the car ahead of it");
  }
}

void RunEvents::Add(const arbitration_t& command, std::optional<double> human_mps2) {
  if (command.header.step <= command_step_) return;
  if (command_step_ < 0 && command.header.step > 0) alarm_ = IsAlarm(command);
  const std::int64_t next = std::exchange(command_step_, command.header.step) + 1;
  NoteAlarm(command, may_lack_commands_ ? command.header.step : next);
  take_over_.Add(command, human_mps2);
  for (const take_over::TakeOverEntry& entry : take_over_.TakeEntries()) {
    if (!entry.first) {
      NoteChange(entry);
    } else if (entry.to != arbitration_t::AUTOMATION && entry.to != arbitration_t::HUMAN) {
      Note(entry, entry.step, KindOf(entry),
           fmt::format("state {}", take_over::NameOfMode(entry.to)));
    }
  }
}

void RunEvents::NoteChange(const take_over::TakeOverEntry& entry) {
  const std::int64_t earliest = may_lack_commands_ ? entry.step : entry.earliest_step;
  const std::size_t place = events_.size();
  Note(entry, earliest, KindOf(entry), std::string(take_over::TextOf(entry, person_)));
  if (events_.size() > place) changes_.push_back({place, entry, earliest});
}

void RunEvents::set_person(const PersonSection& person) {
  person_ = person;
  for (const Change& change : changes_) {
    events_[change.place].text = std::string(take_over::TextOf(change.entry, person_)) +
                                 log::InOneOfTheSteps(change.earliest, change.entry.step);
  }
}

void RunEvents::NoteAlarm(const arbitration_t& command, std::int64_t earliest) {
  const bool alarm = IsAlarm(command);
  if (alarm == std::exchange(alarm_, alarm)) return;
  Note(command.header, earliest, "alarm",
       fmt::format("DoC {:.2f} {} the threshold {:.2f}", command.doc,
                   alarm ? "reaches" : "falls below", command.threshold));
}

}  // namespace fogline::web
