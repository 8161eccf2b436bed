// The events of a run, in the form in which a data recorder in a car would store them (UN R157, 8:
// DSSAD). The events are computed from the commands of the host, which every log contains. Every
// change of mode is an event, also in runs whose driver need not be asked.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "fogline/arbitration_t.hpp"
#include "scenario/sections/person.h"
#include "services/decision/take_over/take_over_request.h"

namespace fogline::take_over {

/// Name of the state that belongs to a mode of HOST_COMMAND; "UNKNOWN" for an invalid mode.
std::string_view NameOfMode(std::int8_t mode);

/// An event of a step. `from` and `to` are the modes before and after the event. They are the same
/// mode in these cases:
/// - The entry is the first entry.
/// - A driver's input becomes effective.
/// - lambda_H passes one half, but the mode does not change with it (on a ramp, or under a policy
///   that shares authority).
/// - A manoeuvre begins, and emergency braking has hidden the state since the beginning of the log.
///   The mode before the manoeuvre is then unknown.
///
/// If emergency braking or its warning begins or ends, `from` and `to` are the modes of the
/// commands. The same is true for the first entry if the log begins late. For other events, `from`
/// and `to` are the modes that the commands would have without emergency braking.
struct TakeOverEntry {
  std::int64_t step = 0;  // the first step whose command shows the event
  // The first step in which the event may have happened. It is earlier than `step` in two cases:
  // the log lacks the commands just before `step`, or the event is an effective input and the log
  // lacks offers of the driver.
  std::int64_t earliest_step = 0;
  std::int64_t utime = 0;
  std::int8_t from = 0;  // mode before the event
  std::int8_t to = 0;
  bool transfer = false;  // whether lambda_H passes kMainAuthority in this event
  bool first = false;     // whether this is the entry of the first command
  std::string_view logged;
};

/// The text that a reader of the log sees for an entry. For an acknowledgement, the text says
/// whether a person or the driver model has acknowledged. The text also says whether a person has
/// overridden.
/// @param person section of the scenario of this run
std::string_view TextOf(const TakeOverEntry& entry, const PersonSection& person);

/// Collects the events and the requests of a run from its commands (HOST_COMMAND), in the order of
/// steps. Some commands may be missing. If a request begins in a gap of missing commands, and the
/// first command after the gap belongs to this request, requests() does not contain the request.
///
/// If the commands of the first steps are missing, the earlier events are unknown. The first entry
/// then says which mode the first command has. requests() does not contain a request that may be
/// open in this command, because the step of the request is unknown (BeganInRequest()). For the
/// same reason requests() does not contain a request that begins behind emergency braking, or in a
/// gap of the log, and has gone on when its mode is seen again.
///
/// The mode of a command says whether the driver has a share of the authority, and lambda_H is this
/// share. This share may be 0 at first, and may grow later. So two different events belong to a
/// take-over. In the first event, the mode gives the driver a share. In the second event, the
/// transfer, lambda_H passes kMainAuthority. If both events happen in one step, one entry covers
/// both. The driver's input is effective if it changes the command by at least
/// kEffectiveInput_mps2. This change is lambda_H (a_H - a), where a is the command before the
/// driver got this share. The automation's part of the command does not count.
///
/// The modes of emergency braking hide the state. In a run with requests, the log uses the last
/// state before the braking. During a collision warning, this state is AUTOMATED or MANUAL, because
/// the warning hides no other state. In a run without requests, the log uses the state of the side
/// with more authority.
class TakeOverLog {
 public:
  /// @param human_mps2 a_H, the driver's offer; nullopt if a_H is not known
  void Add(const arbitration_t& command, std::optional<double> human_mps2);

  const std::vector<TakeOverEntry>& entries() const { return entries_; }
  /// Removes the entries so far, for a caller that needs only the requests of a long run.
  void DropEntries() { entries_.clear(); }
  const std::vector<TakeOverRequest>& requests() const { return requests_; }
  /// Whether a request may have been open before the first command. The result is true if the first
  /// command is of a step after step 0, and the first mode other than EMERGENCY_BRAKING is not
  /// AUTOMATION, HUMAN or COLLISION_WARNING.
  bool BeganInRequest() const { return began_in_request_; }
  /// The mode that the last command would have without emergency braking. The result is AUTOMATION
  /// before the first command. It is EMERGENCY_BRAKING if the log begins late, and all commands so
  /// far have this mode.
  std::int8_t mode() const { return last_ ? last_->mode : arbitration_t::AUTOMATION; }
  /// Removes the entries so far, and all requests except the last request, which may still change.
  /// So a reader of an endless run needs bounded memory. @return the entries
  std::vector<TakeOverEntry> TakeEntries();

 private:
  std::int8_t DecidedMode(const arbitration_t& command) const;
  void Begin(const arbitration_t& command);
  void Reveal(const arbitration_t& command);
  void AddDecided(const arbitration_t& command, std::optional<double> human_mps2);
  void AddEmergency(const arbitration_t& command);
  void Change(const arbitration_t& command, std::int8_t from, bool transfer);
  void NoteUnasked(std::int8_t from, std::int8_t to);
  void Transfer(const arbitration_t& command);
  /// Whether a request began just before this command, where the log lacks commands or emergency
  /// braking hid the mode.
  bool HidesRequest(const arbitration_t& command, std::int8_t from) const;
  void Drive(const arbitration_t& command, std::optional<double> human_mps2);

  // The last command; its mode is the mode that it would have without emergency braking.
  std::optional<arbitration_t> last_;
  std::int8_t last_sent_ = arbitration_t::AUTOMATION;  // mode of the last command
  // The next two fields have a meaning only if the driver has a share of the authority.
  // before_share_mps2_ is the command before the driver got the share; it is empty after the
  // driver's first effective input. asked_ says whether the driver was asked.
  std::optional<double> before_share_mps2_;
  bool asked_ = false;
  // Whether the driver has, or had, authority without an open request. Three events lead to this:
  // an override, the absence of a person who had taken over, and a request whose beginning the log
  // lacks.
  bool unasked_ = false;
  bool asks_ = false;  // whether a command has shown that this is a run with requests
  // Whether the first command is of a step after step 0, and emergency braking has hidden the state
  // since the first command.
  bool hidden_ = false;
  bool began_in_request_ = false;
  std::optional<std::int64_t> unknown_offer_;  // first step of this share with an unknown offer
  std::int64_t earliest_ = 0;                  // the step after the previous command
  std::vector<TakeOverEntry> entries_;
  std::vector<TakeOverRequest> requests_;
};

}  // namespace fogline::take_over
