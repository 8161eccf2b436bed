#include "services/arbitrator/take_over_log.h"

#include <algorithm>

#include "services/minimal_risk/modes.h"

namespace fogline {
namespace {

const TakeOverStateInfo* StateOf(std::int8_t mode) {
  const auto* info = std::ranges::find(kTakeOverStates, mode, &TakeOverStateInfo::mode);
  return info == kTakeOverStates.end() ? nullptr : info;
}

/// What the table says of a change of state, and for changes that it does not have - of drivers who
/// need not be asked, of failed inputs in real time - what they come to.
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
  if (HumanDrives(to)) return "transfer to the driver";
  if (to == arbitration_t::AUTOMATION) return "return to automation";
  return "change of state";
}

}  // namespace

std::string_view NameOfMode(std::int8_t mode) {
  if (mode == arbitration_t::MINIMAL_RISK) return "MINIMAL_RISK";
  const TakeOverStateInfo* info = StateOf(mode);
  return info == nullptr ? "UNKNOWN" : info->name;
}

void TakeOverLog::Add(const arbitration_t& command) {
  if (!last_) {
    entries_.push_back({.step = command.header.step,
                        .utime = command.header.utime,
                        .from = arbitration_t::AUTOMATION,
                        .to = arbitration_t::AUTOMATION,
                        .logged = "activation of the automation"});
  }
  if (command.mode != (last_ ? last_->mode : arbitration_t::AUTOMATION)) Change(command);
  if (HumanDrives(command.mode)) Drive(command);
  last_ = command;
}

void TakeOverLog::Change(const arbitration_t& command) {
  const std::int8_t from = last_ ? last_->mode : arbitration_t::AUTOMATION;
  entries_.push_back({.step = command.header.step,
                      .utime = command.header.utime,
                      .from = from,
                      .to = command.mode,
                      .logged = LoggedOf(from, command.mode)});
  if (HumanDrives(command.mode) != HumanDrives(from)) {
    before_transfer_mps2_.reset();
    if (HumanDrives(command.mode) && last_) before_transfer_mps2_ = last_->acceleration_mps2;
  }
  const TakeOverStateInfo* state = StateOf(command.mode);
  if (state == nullptr) return;
  if (state->state == TakeOverState::kDemand) {
    requests_.push_back({.requested = command.header.step});
  }
  // Where nobody was asked there is no request that could come to anything.
  if (!requests_.empty()) requests_.back().Enter(state->state, command.header.step);
}

void TakeOverLog::Drive(const arbitration_t& command) {
  if (!before_transfer_mps2_) return;
  if (!IsEffective(command.acceleration_mps2, *before_transfer_mps2_)) return;
  before_transfer_mps2_.reset();
  entries_.push_back({.step = command.header.step,
                      .utime = command.header.utime,
                      .from = command.mode,
                      .to = command.mode,
                      .logged = "first effective input of the driver"});
  if (requests_.empty() || !requests_.back().transferred || requests_.back().effective) return;
  requests_.back().effective = command.header.step;
}

}  // namespace fogline
