#include "services/decision/take_over/take_over_log.h"

#include <algorithm>
#include <utility>

#include "services/host_modes.h"

namespace fogline::take_over {
namespace {

constexpr std::string_view kToHuman = "transfer to the human";
constexpr std::string_view kToAutomation = "transfer to the automation";

const TakeOverStateInfo* StateOf(std::int8_t mode) {
  const auto* info = std::ranges::find(kTakeOverStates, mode, &TakeOverStateInfo::mode);
  return info == kTakeOverStates.end() ? nullptr : info;
}

/// The text that the table has for the change from the mode `from` to the mode `to`. Some changes
/// are not in the table. Examples are the transfer to the human in a run without requests, and a
/// change after inputs have failed in real time. This function itself has the texts for these
/// changes.
std::string_view LoggedOf(std::int8_t from, std::int8_t to) {
  const TakeOverStateInfo* a = StateOf(from);
  const TakeOverStateInfo* b = StateOf(to);
  if (a != nullptr && b != nullptr) {
    const auto* row = std::ranges::find_if(kTakeOverTable, [&](const TakeOverRow& r) {
      return r.state == a->state && r.next == b->state;
    });
    if (row != kTakeOverTable.end()) return row->logged;
  }
  if (to == arbitration_t::MINIMAL_RISK) return "manoeuvre begins: inputs have failed";
  if (HumanDrives(to)) return kToHuman;
  if (to == arbitration_t::AUTOMATION) return kToAutomation;
  return "change of state";
}

/// Whether the automation drives, and the driver has not answered: there is no request, or the
/// request has no answer yet. Only an override leads from one of these modes to RECOVERING.
bool IsUnanswered(std::int8_t mode) {
  return mode == arbitration_t::AUTOMATION || mode == arbitration_t::REQUEST ||
         mode == arbitration_t::REQUEST_URGENT;
}

/// Whether this command can occur only in a run with requests. This is true if the mode is a state
/// of a request or of its manoeuvre, or if the mode names the side with less authority.
bool ShowsRequests(const arbitration_t& command) {
  if (command.mode == arbitration_t::AUTOMATION) return HumanDrives(command.lambda_human);
  if (command.mode == arbitration_t::HUMAN) return !HumanDrives(command.lambda_human);
  return StateOf(command.mode) != nullptr;
}

}  // namespace

std::string_view NameOfMode(std::int8_t mode) {
  if (mode == arbitration_t::MINIMAL_RISK) return "MINIMAL_RISK";
  if (mode == arbitration_t::COLLISION_WARNING) return "COLLISION_WARNING";
  if (mode == arbitration_t::EMERGENCY_BRAKING) return "EMERGENCY_BRAKING";
  const TakeOverStateInfo* info = StateOf(mode);
  return info == nullptr ? "UNKNOWN" : info->name;
}

std::string_view TextOf(const TakeOverEntry& entry, const PersonSection& person) {
  if (entry.from == entry.to) return entry.logged;
  if (person.drives && entry.to == arbitration_t::MINIMAL_RISK) {
    return "manoeuvre begins: inputs or person gone";
  }
  if (person.drives && HumanDrives(entry.from) && InMinimalRisk(entry.to)) {
    return "manoeuvre begins: person gone";
  }
  if (person.drives && person.override_by != OverrideBy::kNone && IsUnanswered(entry.from) &&
      entry.to == arbitration_t::RECOVERING) {
    return "override by the person";
  }
  if (entry.to != arbitration_t::HANDOVER) return entry.logged;
  return person.drives ? "acknowledgement by the person" : "acknowledgement (driver model)";
}

void TakeOverLog::Add(const arbitration_t& command, std::optional<double> human_mps2) {
  earliest_ = last_ ? last_->header.step + 1 : command.header.step;
  if (!last_) Begin(command);
  if (hidden_ && command.mode != arbitration_t::EMERGENCY_BRAKING) Reveal(command);
  asks_ = asks_ || ShowsRequests(command);
  arbitration_t decided = command;
  decided.mode = DecidedMode(command);
  AddDecided(decided, human_mps2);
  AddEmergency(command);
  last_sent_ = command.mode;
}

void TakeOverLog::Begin(const arbitration_t& command) {
  const bool late = command.header.step > 0;
  const std::int8_t mode = late ? command.mode : std::int8_t{arbitration_t::AUTOMATION};
  entries_.push_back(
      {.step = command.header.step,
       .earliest_step = earliest_,
       .utime = command.header.utime,
       .from = mode,
       .to = mode,
       .first = true,
       .logged = late ? "first command of the log" : "activation of the automation"});
  last_sent_ = mode;
  if (!late) return;
  hidden_ = true;
  last_ = command;
}

void TakeOverLog::Reveal(const arbitration_t& command) {
  hidden_ = false;
  last_->mode = DecidedMode(command);
  began_in_request_ =
      last_->mode != arbitration_t::AUTOMATION && last_->mode != arbitration_t::HUMAN;
  // If a manoeuvre follows emergency braking, the manoeuvre begins in this step. It did not run
  // before, because the mode of emergency braking never replaces a mode of a manoeuvre.
  if (!InEmergency(last_sent_) || !InMinimalRisk(command.mode)) return;
  entries_.push_back({.step = command.header.step,
                      .earliest_step = earliest_,
                      .utime = command.header.utime,
                      .from = command.mode,
                      .to = command.mode,
                      .logged = "manoeuvre begins"});
}

std::vector<TakeOverEntry> TakeOverLog::TakeEntries() {
  if (requests_.size() > 1) requests_.erase(requests_.begin(), requests_.end() - 1);
  return std::exchange(entries_, {});
}

std::int8_t TakeOverLog::DecidedMode(const arbitration_t& command) const {
  if (hidden_ || !InEmergency(command.mode)) return command.mode;
  if (last_ && asks_) {
    if (command.mode == arbitration_t::EMERGENCY_BRAKING) return last_->mode;
    // The mode of a collision warning replaces only the modes AUTOMATION and HUMAN. So the decided
    // mode is one of these two modes. After RECOVERING it is HUMAN, because HUMAN follows
    // RECOVERING.
    if (last_->mode == arbitration_t::AUTOMATION || HumanDrives(last_->mode)) {
      return HumanDrives(last_->mode) ? arbitration_t::HUMAN : arbitration_t::AUTOMATION;
    }
  }
  return HumanDrives(command.lambda_human) ? arbitration_t::HUMAN : arbitration_t::AUTOMATION;
}

void TakeOverLog::AddEmergency(const arbitration_t& command) {
  if (command.mode == last_sent_) return;
  const auto add = [&](std::string_view logged) {
    entries_.push_back({.step = command.header.step,
                        .earliest_step = earliest_,
                        .utime = command.header.utime,
                        .from = last_sent_,
                        .to = command.mode,
                        .logged = logged});
  };
  if (last_sent_ == arbitration_t::EMERGENCY_BRAKING) add("emergency braking ends");
  const bool warned = last_sent_ == arbitration_t::COLLISION_WARNING;
  if (command.mode == arbitration_t::EMERGENCY_BRAKING) {
    add("emergency braking begins");
  } else if (command.mode == arbitration_t::COLLISION_WARNING) {
    add("collision warning begins");
  } else if (warned) {
    add("collision warning ends");
  }
}

void TakeOverLog::AddDecided(const arbitration_t& command, std::optional<double> human_mps2) {
  const std::int8_t from = last_ ? last_->mode : arbitration_t::AUTOMATION;
  const bool human = HumanDrives(command.lambda_human);
  const bool transfer = last_ && human != HumanDrives(last_->lambda_human);
  const bool with_state =
      HumanDrives(command.mode) != HumanDrives(from) && HumanDrives(command.mode) == human;
  if (command.mode != from) Change(command, from, transfer && with_state);
  if (transfer) Transfer(command);
  if (transfer && !with_state) {
    entries_.push_back({.step = command.header.step,
                        .earliest_step = earliest_,
                        .utime = command.header.utime,
                        .from = command.mode,
                        .to = command.mode,
                        .transfer = true,
                        .logged = human ? kToHuman : kToAutomation});
  }
  if (HumanDrives(command.mode)) Drive(command, human_mps2);
  last_ = command;
}

void TakeOverLog::Change(const arbitration_t& command, std::int8_t from, bool transfer) {
  const bool has_share = HumanDrives(command.mode);
  const bool share_changes = has_share != HumanDrives(from);
  std::string_view logged = LoggedOf(from, command.mode);
  if (share_changes && !transfer) {
    const bool has_all = !last_ && HumanDrives(command.lambda_human);  // from the first step on
    if (has_share && !has_all) logged = "human takes part";
    if (command.mode == arbitration_t::AUTOMATION) logged = "human is released";
  }
  entries_.push_back({.step = command.header.step,
                      .earliest_step = earliest_,
                      .utime = command.header.utime,
                      .from = from,
                      .to = command.mode,
                      .transfer = transfer,
                      .logged = logged});
  NoteUnasked(from, command.mode);
  if (HidesRequest(command, from)) {
    unasked_ = true;
    asked_ = false;
    before_share_mps2_.reset();
  }
  if (share_changes) {
    before_share_mps2_.reset();
    unknown_offer_.reset();
    if (has_share && last_) before_share_mps2_ = last_->acceleration_mps2;
    asked_ = command.mode == arbitration_t::RECOVERING && !unasked_;
  }
  const TakeOverStateInfo* state = StateOf(command.mode);
  if (state == nullptr) return;
  if (state->state == TakeOverState::kDemand) {
    requests_.push_back({.requested = command.header.step});
  }
  // The change of state may belong to no request, for example after an override without a request
  // (unasked_). Then no request notes it.
  if (requests_.empty() || unasked_) return;
  requests_.back().Enter(state->state, command.header.step);
  // Enter() has set `transferred`. But in kRecovering the driver's share may still be small. So the
  // field is emptied here, and Transfer() sets it.
  if (state->state == TakeOverState::kRecovering) requests_.back().transferred.reset();
}

void TakeOverLog::NoteUnasked(std::int8_t from, std::int8_t to) {
  if (to == arbitration_t::AUTOMATION || to == arbitration_t::REQUEST) unasked_ = false;
  const bool overrides = from == arbitration_t::AUTOMATION && to == arbitration_t::RECOVERING;
  const bool has_taken_over =
      HumanDrives(from) && !requests_.empty() && requests_.back().transferred;
  const bool leaves = has_taken_over && InMinimalRisk(to) && to != arbitration_t::MINIMAL_RISK;
  if (overrides || leaves) unasked_ = true;
}

bool TakeOverLog::HidesRequest(const arbitration_t& command, std::int8_t from) const {
  const bool was_hidden = last_sent_ == arbitration_t::EMERGENCY_BRAKING;
  if (earliest_ == command.header.step && !was_hidden) return false;
  const bool has_answered = from == arbitration_t::HUMAN || from == arbitration_t::RECOVERING;
  if (InMinimalRisk(command.mode)) return from == arbitration_t::AUTOMATION;
  if (command.mode == arbitration_t::REQUEST_URGENT) return from != arbitration_t::REQUEST;
  if (command.mode == arbitration_t::HANDOVER) {
    return has_answered || from == arbitration_t::AUTOMATION;
  }
  return command.mode == arbitration_t::RECOVERING && from == arbitration_t::HUMAN;
}

void TakeOverLog::Transfer(const arbitration_t& command) {
  const bool answers = asked_ && HumanDrives(command.mode) && HumanDrives(command.lambda_human);
  if (!answers || requests_.empty() || requests_.back().transferred) return;
  requests_.back().transferred = command.header.step;
}

void TakeOverLog::Drive(const arbitration_t& command, std::optional<double> human_mps2) {
  if (!before_share_mps2_) return;
  if (!human_mps2) {
    if (!unknown_offer_) unknown_offer_ = command.header.step;
    return;
  }
  if (!IsEffective(command.lambda_human, *human_mps2, *before_share_mps2_)) return;
  before_share_mps2_.reset();
  entries_.push_back({.step = command.header.step,
                      .earliest_step = earliest_,
                      .utime = command.header.utime,
                      .from = command.mode,
                      .to = command.mode,
                      .logged = "first effective input of the human"});
  if (unknown_offer_) entries_.back().earliest_step = std::min(earliest_, *unknown_offer_);
  if (asked_ && !requests_.empty()) requests_.back().effective = command.header.step;
}

}  // namespace fogline::take_over
